#include "mstsl/viz/canvas.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <new>
#include <utility>

#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include "mstsl/core/angles.hpp"
#include "mstsl/io/atomic_file.hpp"

namespace mstsl::viz {
namespace {

using SurfacePtr = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using ContextPtr = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

SurfacePtr own(cairo_surface_t* surface) { return {surface, &cairo_surface_destroy}; }
ContextPtr context_on(const SurfacePtr& surface) { return {cairo_create(surface.get()), &cairo_destroy}; }

void set_color(cairo_t* context, const Color& color) {
  cairo_set_source_rgba(context, color.red, color.green, color.blue, color.alpha);
}

void set_stroke(cairo_t* context, const Stroke& stroke) {
  set_color(context, stroke.color);
  cairo_set_line_width(context, stroke.width);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(context, stroke.dashes.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
  cairo_set_dash(context, stroke.dashes.data(), static_cast<int>(stroke.dashes.size()), 0.0);
}

void set_font(cairo_t* context, const TextStyle& style) {
  cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, style.size);
}

void trace(cairo_t* context, const Points& points) {
  cairo_new_path(context);
  for (const Eigen::Vector2d& point : points) cairo_line_to(context, point.x(), point.y());
}

void trace(cairo_t* context, const Eigen::AlignedBox2d& box, double radius) {
  cairo_new_path(context);
  if (radius <= 0.0) {
    cairo_rectangle(context, box.min().x(), box.min().y(), box.sizes().x(), box.sizes().y());
    return;
  }
  cairo_arc(context, box.max().x() - radius, box.min().y() + radius, radius, -kPi / 2, 0.0);
  cairo_arc(context, box.max().x() - radius, box.max().y() - radius, radius, 0.0, kPi / 2);
  cairo_arc(context, box.min().x() + radius, box.max().y() - radius, radius, kPi / 2, kPi);
  cairo_arc(context, box.min().x() + radius, box.min().y() + radius, radius, kPi, 3 * kPi / 2);
  cairo_close_path(context);
}

std::uint32_t premultiplied(std::uint32_t pixel) {
  const std::uint32_t alpha = pixel >> 24;
  const auto channel = [&](int shift) { return ((pixel >> shift & 0xffU) * alpha + 127) / 255 << shift; };
  return alpha << 24 | channel(16) | channel(8) | channel(0);
}

SurfacePtr to_surface(const Raster& raster) {
  SurfacePtr surface = own(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, raster.width, raster.height));
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
  unsigned char* rows = cairo_image_surface_get_data(surface.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
  const auto width = static_cast<std::size_t>(raster.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(raster.height); ++y) {
    auto* row = reinterpret_cast<std::uint32_t*>(rows + y * stride);
    std::transform(raster.pixels.begin() + static_cast<std::ptrdiff_t>(y * width),
                   raster.pixels.begin() + static_cast<std::ptrdiff_t>((y + 1) * width), row, premultiplied);
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

cairo_status_t append(void* text, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

void replay(const SurfacePtr& recording, const SurfacePtr& onto) {
  const ContextPtr context = context_on(onto);
  cairo_set_source_surface(context.get(), recording.get(), 0.0, 0.0);
  cairo_paint(context.get());
}

std::string to_png(const SurfacePtr& recording, double width, double height) {
  std::string bytes;
  const SurfacePtr surface = own(cairo_image_surface_create(
      CAIRO_FORMAT_RGB24, static_cast<int>(std::ceil(width)), static_cast<int>(std::ceil(height))));
  replay(recording, surface);
  cairo_surface_write_to_png_stream(surface.get(), append, &bytes);
  return bytes;
}

std::string to_svg(const SurfacePtr& recording, double width, double height) {
  std::string bytes;
  const SurfacePtr surface = own(cairo_svg_surface_create_for_stream(append, &bytes, width, height));
  replay(recording, surface);
  cairo_surface_finish(surface.get());
  return bytes;
}

}  // namespace

/// What is drawn is recorded, and played onto PNG or SVG when saved.
struct Canvas::State {
  double width;
  double height;
  SurfacePtr recording;
  ContextPtr context;

  State(double w, double h)
      : width(w), height(h), recording(nullptr, &cairo_surface_destroy), context(nullptr, &cairo_destroy) {
    const cairo_rectangle_t extents{0.0, 0.0, w, h};
    recording = own(cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, &extents));
    context = context_on(recording);
  }
};

Canvas::Canvas(double width, double height, const Color& background)
    : state_(std::make_unique<State>(width, height)) {
  assert(width >= 1.0 && width <= 20'000.0 && height >= 1.0 && height <= 20'000.0);
  set_color(state_->context.get(), background);
  cairo_paint(state_->context.get());
}
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;
Canvas::~Canvas() = default;

double Canvas::width() const { return state_->width; }
double Canvas::height() const { return state_->height; }

void Canvas::polyline(const Points& points, const Stroke& stroke) {
  set_stroke(state_->context.get(), stroke);
  trace(state_->context.get(), points);
  cairo_stroke(state_->context.get());
}

void Canvas::polygon(const Points& points, const Color& fill) {
  set_color(state_->context.get(), fill);
  trace(state_->context.get(), points);
  cairo_fill(state_->context.get());
}

void Canvas::rectangle(const Eigen::AlignedBox2d& box, const Color& fill, double corner_radius) {
  set_color(state_->context.get(), fill);
  trace(state_->context.get(), box, corner_radius);
  cairo_fill(state_->context.get());
}

void Canvas::outline(const Eigen::AlignedBox2d& box, const Stroke& stroke, double corner_radius) {
  set_stroke(state_->context.get(), stroke);
  trace(state_->context.get(), box, corner_radius);
  cairo_stroke(state_->context.get());
}

void Canvas::disc(const Eigen::Vector2d& center, double radius, const Color& fill) {
  set_color(state_->context.get(), fill);
  cairo_new_path(state_->context.get());
  cairo_arc(state_->context.get(), center.x(), center.y(), radius, 0.0, 2 * kPi);
  cairo_fill(state_->context.get());
}

void Canvas::circle(const Eigen::Vector2d& center, double radius, const Stroke& stroke) {
  set_stroke(state_->context.get(), stroke);
  cairo_new_path(state_->context.get());
  cairo_arc(state_->context.get(), center.x(), center.y(), radius, 0.0, 2 * kPi);
  cairo_stroke(state_->context.get());
}

double Canvas::text_width(const std::string& words, const TextStyle& style) const {
  set_font(state_->context.get(), style);
  cairo_text_extents_t extents{};
  cairo_text_extents(state_->context.get(), words.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(const Eigen::Vector2d& at, const std::string& words, const TextStyle& style) {
  cairo_t* context = state_->context.get();
  const double width = text_width(words, style);
  const double shift = style.anchor == Anchor::kStart    ? 0.0
                       : style.anchor == Anchor::kMiddle ? width / 2
                                                         : width;
  cairo_save(context);
  cairo_translate(context, at.x(), at.y());
  if (style.upwards) cairo_rotate(context, -kPi / 2);
  cairo_move_to(context, -shift, 0.0);
  set_font(context, style);
  set_color(context, style.color);
  cairo_show_text(context, words.c_str());
  cairo_restore(context);
}

void Canvas::image(const Raster& raster, const Eigen::Affine2d& canvas_T_raster) {
  assert(raster.pixels.size() ==
         static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height));
  if (raster.pixels.empty()) return;
  const SurfacePtr surface = to_surface(raster);
  const Eigen::Matrix3d& m = canvas_T_raster.matrix();
  const cairo_matrix_t matrix{m(0, 0), m(1, 0), m(0, 1), m(1, 1), m(0, 2), m(1, 2)};
  cairo_t* context = state_->context.get();
  cairo_save(context);
  cairo_transform(context, &matrix);
  cairo_set_source_surface(context, surface.get(), 0.0, 0.0);
  cairo_pattern_set_filter(cairo_get_source(context), CAIRO_FILTER_GOOD);
  cairo_pattern_set_extend(cairo_get_source(context),
                           CAIRO_EXTEND_PAD);  // else the outermost pixels fade away
  cairo_new_path(context);
  cairo_rectangle(context, 0.0, 0.0, raster.width, raster.height);
  cairo_fill(context);
  cairo_restore(context);
}

void Canvas::clip(const Eigen::AlignedBox2d& box) {
  end_clip();
  trace(state_->context.get(), box, 0.0);
  cairo_clip(state_->context.get());
}

void Canvas::end_clip() { cairo_reset_clip(state_->context.get()); }

Result<void> Canvas::save(const std::filesystem::path& file) const {
  const std::string ending = file.extension().string();
  const bool svg = ending == ".svg";
  if (!svg && ending != ".png")
    return Error(fmt::format("cannot draw {}: its name must end in .png or .svg", file.string()));
  const std::string bytes = svg ? to_svg(state_->recording, state_->width, state_->height)
                                : to_png(state_->recording, state_->width, state_->height);
  if (bytes.empty())
    return Error(fmt::format("cannot draw {}: there is not enough memory for it", file.string()));
  return io::write_file(file, bytes);
}

std::uint32_t to_pixel(const Color& color) {
  const auto byte = [](double value) {
    return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
  };
  return byte(color.alpha) << 24 | byte(color.red) << 16 | byte(color.green) << 8 | byte(color.blue);
}

}  // namespace mstsl::viz
