#pragma once

#include "mstsl/viz/color.hpp"

/// The colours that every drawing shares.
namespace mstsl::viz::theme {

inline constexpr Color kPaper = Color::hex(0xffffff);
inline constexpr Color kUnknown = Color::hex(0xeceff2);
inline constexpr Color kFloor = Color::hex(0xffffff);
inline constexpr Color kWall = Color::hex(0x1f2933);
inline constexpr Color kInk = Color::hex(0x1f2933);
inline constexpr Color kFaintInk = Color::hex(0x66727f);
inline constexpr Color kHairline = Color::hex(0xd5dae0);
inline constexpr Color kTruth = Color::hex(0x10151b);
inline constexpr Color kEstimate = Color::hex(0xff4d2e);
inline constexpr Color kHypothesis = Color::hex(0xe6007e);
inline constexpr Color kRejected = Color::hex(0x8a949e);
inline constexpr Color kScan = Color::hex(0xd6006c);

}  // namespace mstsl::viz::theme
