#include "steelwork.hpp"

#include <algorithm>
#include <cmath>

#include "mstsl/core/angles.hpp"

namespace mstsl::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Remanence of steel as it is found in buildings, A/m. Rolled and handled steel keeps 0.005 to 0.12 T (4e3 to
// 1e5 A/m): lifting magnets, welding and bending leave the most; saturation would be 1.7e6. Set once so that
// the field's spread, correlation length and gradients are those of the real recordings
// (tests/sim/field_statistics_test.cpp).
constexpr double kBar_A_per_m = 1.2e4;
constexpr double kSection_A_per_m = 2.2e4;
constexpr double kSheet_A_per_m = 2.5e4;
constexpr double kColdFormed_A_per_m = 9.5e4;
/// Pieces differ by their history: spread of the logarithm.
constexpr double kHistorySpread = 0.5;

/// Magnetisation changes its sign and size along a piece over such lengths, m.
struct DomainLength {
  double shortest_m, longest_m;
};
constexpr DomainLength kBarDomain{0.6, 2.5};
constexpr DomainLength kBeamDomain{1.5, 5.0};

double history(Random& random) { return std::exp(kHistorySpread * random.normal()); }

Vector3d lift(const Vector2d& point_m, double z_m) { return {point_m.x(), point_m.y(), z_m}; }

void add_rod(Rods& rods, const Vector3d& from_m, const Vector3d& to_m, double section_m2,
             double remanence_sigma, Random& random) {
  rods.push_back({from_m, to_m, section_m2, remanence_sigma * random.normal()});
}

/// A long piece, cut where its magnetisation changes.
void add_bar(Rods& rods, const Vector3d& from_m, const Vector3d& to_m, double section_m2,
             double remanence_sigma, Random& random, DomainLength domain = kBarDomain) {
  const double whole_m = (to_m - from_m).norm();
  double done_m = 0.0;
  while (whole_m - done_m > 1e-6) {
    double piece_m = random.uniform(domain.shortest_m, domain.longest_m);
    if (whole_m - done_m - piece_m < domain.shortest_m) piece_m = whole_m - done_m;
    const Vector3d a = from_m + (to_m - from_m) * (done_m / whole_m);
    const Vector3d b = from_m + (to_m - from_m) * ((done_m + piece_m) / whole_m);
    add_rod(rods, a, b, section_m2, remanence_sigma, random);
    done_m += piece_m;
  }
}

/// The four corners of a box at a pose.
std::vector<Vector2d> corners(const Pose2& map_T_middle, const Vector2d& size_m) {
  std::vector<Vector2d> points;
  for (const Segment& side : box(map_T_middle, size_m)) points.push_back(side.a);
  return points;
}

}  // namespace

void add_slab(Rods& rods, const Pose2& map_T_area, const Eigen::AlignedBox2d& area_m, double z_m,
              Random& random) {
  // Mesh of 10 mm bars 0.15 m apart; every fourth is modelled, with the steel of two: neighbours' random
  // parts add up to the root of their number.
  constexpr double kSpacing_m = 0.6;
  constexpr double kSection_m2 = 2 * 7.9e-5;
  const Vector2d low = area_m.min(), high = area_m.max();
  for (int axis = 0; axis < 2; ++axis) {
    const int other = 1 - axis;
    for (double at = low[other] + random.uniform(0.0, kSpacing_m); at < high[other]; at += kSpacing_m) {
      Vector2d from, to;
      from[axis] = low[axis];
      to[axis] = high[axis];
      from[other] = to[other] = at;
      add_bar(rods, lift(map_T_area * from, z_m), lift(map_T_area * to, z_m), kSection_m2, kBar_A_per_m,
              random);
    }
  }
}

void add_beams(Rods& rods, const Pose2& map_T_area, const Eigen::AlignedBox2d& area_m, double z_m,
               double spacing_m, Random& random) {
  constexpr double kSection_m2 = 6.5e-3;  // IPE 300 is 5.4e-3, HEB 180 6.5e-3; as much as 13 bars of 25 mm
  constexpr double kDepth_m = 0.3;        // of the beam's middle below the slab's
  const Vector2d low = area_m.min(), high = area_m.max();
  const auto add = [&](const Vector2d& from, const Vector2d& to) {
    add_bar(rods, lift(map_T_area * from, z_m - kDepth_m), lift(map_T_area * to, z_m - kDepth_m), kSection_m2,
            kSection_A_per_m * history(random), random, kBeamDomain);
  };
  for (double x = low.x() + 0.5 * std::fmod(high.x() - low.x(), spacing_m); x <= high.x(); x += spacing_m)
    add({x, low.y()}, {x, high.y()});
  for (const double y : {low.y(), high.y()}) add({low.x(), y}, {high.x(), y});
}

void add_concrete_column(Rods& rods, const Vector2d& at_m, double height_m, Random& random) {
  constexpr double kBarSection_m2 = 4.9e-4;  // 25 mm
  const double sigma = kBar_A_per_m * history(random);
  for (const Vector2d& corner : corners(Pose2::from(at_m, 0), Vector2d(0.3, 0.3)))
    add_bar(rods, lift(corner, -0.3), lift(corner, height_m + 0.3), kBarSection_m2, sigma, random);
}

void add_steel_column(Rods& rods, const Vector2d& at_m, double height_m, Random& random) {
  constexpr double kSection_m2 = 5.4e-3;  // HEB 160
  add_bar(rods, lift(at_m, -0.2), lift(at_m, height_m), kSection_m2, kSection_A_per_m * history(random),
          random);
}

void add_door_frame(Rods& rods, const Pose2& map_T_door, double width_m, Random& random) {
  constexpr double kFrame_m2 = 4.5e-4;  // 1.5 mm sheet, 0.3 m girth
  constexpr double kLeaf_m2 = 1.6e-3;   // two 0.8 mm skins
  constexpr double kHeight_m = 2.1;
  constexpr double kShareOfSteelLeaves = 0.3;
  const double sigma = kSheet_A_per_m * history(random);
  const Vector2d left = map_T_door * Vector2d(-0.5 * width_m, 0),
                 right = map_T_door * Vector2d(0.5 * width_m, 0);
  add_rod(rods, lift(left, 0.02), lift(left, kHeight_m), kFrame_m2, sigma, random);
  add_rod(rods, lift(right, 0.02), lift(right, kHeight_m), kFrame_m2, sigma, random);
  add_rod(rods, lift(left, kHeight_m), lift(right, kHeight_m), kFrame_m2, sigma, random);
  if (!random.chance(kShareOfSteelLeaves)) return;
  for (const double x : {-0.3, 0.0, 0.3}) {
    const Vector2d at = map_T_door * Vector2d(x * width_m, 0.0);
    add_rod(rods, lift(at, 0.05), lift(at, kHeight_m - 0.05), kLeaf_m2 / 3, sigma, random);
  }
}

void add_radiator(Rods& rods, const Pose2& map_T_radiator, double width_m, Random& random) {
  constexpr double kSection_m2 = 1.0e-3;
  const double sigma = kSheet_A_per_m * history(random);
  for (const double z : {0.15, 0.65})
    add_rod(rods, lift(map_T_radiator * Vector2d(-0.5 * width_m, 0), z),
            lift(map_T_radiator * Vector2d(0.5 * width_m, 0), z), kSection_m2, sigma, random);
}

void add_tray(Rods& rods, const Segment& course, double z_m, Random& random) {
  constexpr double kSection_m2 = 8e-4;
  add_bar(rods, lift(course.a, z_m), lift(course.b, z_m), kSection_m2, kSheet_A_per_m * history(random),
          random);
}

void add_cabinet(Rods& rods, const Pose2& map_T_cabinet, const Vector2d& size_m, double height_m,
                 Random& random) {
  constexpr double kPost_m2 = 4e-4;
  const double sigma = kSheet_A_per_m * history(random);
  const auto points = corners(map_T_cabinet, size_m);
  for (const Vector2d& corner : points)
    add_rod(rods, lift(corner, 0.05), lift(corner, height_m), kPost_m2, sigma, random);
  for (const double z : {0.1, 0.5 * height_m, height_m})
    add_rod(rods, lift(points[0], z), lift(points[1], z), kPost_m2, sigma, random);
}

void add_machine(Rods& rods, const Vector2d& at_m, double size_m, Random& random) {
  constexpr int kParts = 6;
  constexpr double kSection_m2 = 3e-3;
  for (int i = 0; i < kParts; ++i) {
    const Vector3d middle =
        lift(at_m, 1.0) + Vector3d(random.uniform(-0.4, 0.4) * size_m, random.uniform(-0.4, 0.4) * size_m,
                                   random.uniform(-0.5, 0.8));
    Vector3d half = Vector3d(random.normal(), random.normal(), random.normal());
    half *= 0.5 * random.uniform(0.5, 1.0) * size_m / std::max(half.norm(), 1e-3);
    add_rod(rods, middle - half, middle + half, kSection_m2, kSection_A_per_m * history(random), random);
  }
}

void add_car(Rods& rods, const Pose2& map_T_car, const Vector2d& size_m, Random& random) {
  constexpr double kSheet_m2 = 1.2e-3, kSolid_m2 = 4e-3;
  const double sheet = 0.4 * kSheet_A_per_m * history(random),
               solid = 0.3 * kSection_A_per_m * history(random);
  const auto at = [&](double x, double y, double z) {
    return lift(map_T_car * Vector2d(x * size_m.x(), y * size_m.y()), z);
  };
  add_rod(rods, at(0.25, -0.15, 0.5), at(0.4, 0.15, 0.6), 3 * kSolid_m2, solid,
          random);  // engine and gearbox
  for (const double x : {-0.3, 0.3})
    add_rod(rods, at(x, -0.42, 0.3), at(x, 0.42, 0.3), kSolid_m2, solid, random);
  for (const double y : {-0.45, 0.45}) {
    add_rod(rods, at(-0.3, y, 0.35), at(0.3, y, 0.35), kSheet_m2, sheet, random);
    add_rod(rods, at(-0.15, 0.8 * y, 1.4), at(0.15, 0.8 * y, 1.4), kSheet_m2, sheet, random);
  }
  for (const double x : {-0.48, 0.48})
    add_rod(rods, at(x, -0.4, 0.5), at(x, 0.4, 0.5), kSheet_m2, sheet, random);
}

void add_rack_frame(Rods& rods, const Pose2& map_T_frame, double depth_m, double height_m, Random& random) {
  constexpr double kPost_m2 = 1e-3, kBrace_m2 = 2e-4;  // 120 mm section, 2.5 mm thick
  const double sigma = kColdFormed_A_per_m * history(random);
  const Vector2d front = map_T_frame * Vector2d(0, -0.5 * depth_m),
                 back = map_T_frame * Vector2d(0, 0.5 * depth_m);
  add_bar(rods, lift(front, 0.02), lift(front, height_m), kPost_m2, sigma, random);
  add_bar(rods, lift(back, 0.02), lift(back, height_m), kPost_m2, sigma, random);
  for (double z = 0.3; z + 0.9 < height_m; z += 1.8)
    add_rod(rods, lift(front, z), lift(back, z + 0.9), kBrace_m2, sigma, random);
}

void add_rack_beam(Rods& rods, const Segment& course, double z_m, Random& random) {
  constexpr double kSection_m2 = 9e-4;  // box 120 x 50 mm, 2.5 mm thick
  add_bar(rods, lift(course.a, z_m), lift(course.b, z_m), kSection_m2, kColdFormed_A_per_m * history(random),
          random);
}

}  // namespace mstsl::sim
