#include "mstsl/viz/color.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace mstsl::viz {
namespace {

/// Every 16th entry of viridis' 256, and the last; between them it is straight to within a 1/255.
constexpr std::array<std::uint32_t, 17> kViridis{0x440154, 0x481769, 0x472a7a, 0x433d84, 0x3d4e8a, 0x355e8d,
                                                 0x2e6d8e, 0x297b8e, 0x23898e, 0x1f978b, 0x21a585, 0x2eb37c,
                                                 0x46c06f, 0x65cb5e, 0x89d548, 0xb0dd2f, 0xfde725};

constexpr std::array<std::uint32_t, 8> kOkabeIto{0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7,
                                                 0xe69f00, 0x56b4e9, 0x000000, 0xf0e442};

}  // namespace

Color viridis(double share) {
  // The first 16 stops are 16 entries apart, the last one 15.
  const double entry = std::clamp(std::isfinite(share) ? share : 0.0, 0.0, 1.0) * 255.0;
  const std::size_t low = std::min<std::size_t>(static_cast<std::size_t>(entry / 16.0), 15);
  const double step = low == 15 ? 15.0 : 16.0;
  const double t = (entry - 16.0 * static_cast<double>(low)) / step;
  const Color a = Color::hex(kViridis[low]);
  const Color b = Color::hex(kViridis[low + 1]);
  return {a.red + t * (b.red - a.red), a.green + t * (b.green - a.green), a.blue + t * (b.blue - a.blue)};
}

Color palette(std::size_t index) { return Color::hex(kOkabeIto[index % kOkabeIto.size()]); }

}  // namespace mstsl::viz
