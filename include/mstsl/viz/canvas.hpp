#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mstsl/core/result.hpp"
#include "mstsl/viz/color.hpp"

namespace mstsl::viz {

using Points = std::vector<Eigen::Vector2d>;

struct Stroke {
  Color color;
  double width = 1.0;
  std::vector<double> dashes;  ///< lengths of dash, gap, ... ; none for a full line
};

enum class Anchor { kStart, kMiddle, kEnd };

struct TextStyle {
  double size = 16.0;
  Color color = Color::hex(0x1f2933);
  Anchor anchor = Anchor::kStart;
  bool bold = false;
  bool upwards = false;  ///< written from bottom to top
};

/// Pixels from left to right, the top row first, each 0xAARRGGBB, colours not multiplied by alpha.
struct Raster {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> pixels;
};

std::uint32_t to_pixel(const Color& color);

/// A sheet to draw on, in px, y downwards; saved as PNG or SVG.
class Canvas {
 public:
  /// Expects a size of 1 to 20,000 px each way.
  Canvas(double width, double height, const Color& background = Color::hex(0xffffff));
  Canvas(Canvas&&) noexcept;
  Canvas& operator=(Canvas&&) noexcept;
  ~Canvas();

  double width() const;
  double height() const;

  void polyline(const Points& points, const Stroke& stroke);
  void polygon(const Points& points, const Color& fill);
  void rectangle(const Eigen::AlignedBox2d& box, const Color& fill, double corner_radius = 0.0);
  void outline(const Eigen::AlignedBox2d& box, const Stroke& stroke, double corner_radius = 0.0);
  void disc(const Eigen::Vector2d& center, double radius, const Color& fill);
  void circle(const Eigen::Vector2d& center, double radius, const Stroke& stroke);

  /// Text whose baseline begins, has its middle or ends at `at`.
  void text(const Eigen::Vector2d& at, const std::string& words, const TextStyle& style);
  double text_width(const std::string& words, const TextStyle& style) const;

  /// A raster laid onto the sheet by `canvas_T_raster`, which maps its pixel corners (x right, y down) to px.
  void image(const Raster& raster, const Eigen::Affine2d& canvas_T_raster);

  /// Until the next clip or end_clip(), nothing is drawn outside of the box.
  void clip(const Eigen::AlignedBox2d& box);
  void end_clip();

  /// Writes PNG or SVG by the file's ending, atomically. Errors: another ending, a full disk.
  Result<void> save(const std::filesystem::path& file) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mstsl::viz
