#pragma once

#include <cstddef>
#include <cstdint>

namespace mstsl::viz {

/// A colour in sRGB with opacity, each 0 to 1.
struct Color {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
  double alpha = 1.0;

  /// From 0xRRGGBB.
  static constexpr Color hex(std::uint32_t rgb, double alpha = 1.0) {
    return {static_cast<double>(rgb >> 16 & 0xffU) / 255.0, static_cast<double>(rgb >> 8 & 0xffU) / 255.0,
            static_cast<double>(rgb & 0xffU) / 255.0, alpha};
  }
  constexpr Color with_alpha(double new_alpha) const { return {red, green, blue, new_alpha}; }
};

/// The perceptually uniform colour map viridis (van der Walt & Smith, CC0) at `share`, clamped to 0 .. 1.
Color viridis(double share);

/// Colours that stay apart for colour-blind eyes (Okabe & Ito 2008), again and again by index.
Color palette(std::size_t index);

}  // namespace mstsl::viz
