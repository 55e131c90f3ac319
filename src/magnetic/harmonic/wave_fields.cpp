#include "wave_fields.hpp"

namespace mstsl {

using Complex = std::complex<double>;
using Eigen::Array3d;
using Eigen::Index;
using Eigen::MatrixXd;
using Wave = WaveBox::Wave;

std::vector<PotentialPart> parts_of(SourceSide side) {
  std::vector<PotentialPart> parts;
  for (const std::vector<int>& components : coupled_components(side)) {
    PotentialPart& part =
        parts.emplace_back(PotentialPart{Array3d::Zero(), side == SourceSide::kAbove ? -1.0 : 1.0});
    for (const int c : components) part.component(c) = 1.0;
  }
  return parts;
}

Complex field_of(const Wave& wave, const PotentialPart& part, int c) {
  if (part.component(c) == 0.0) return 0.0;
  return c == 2 ? Complex(part.vertical * wave.amplitude, 0.0)
                : Complex(0.0, -wave.direction(c) * wave.amplitude);
}

LongTerm long_term(const WaveBox& box, const PotentialPart& part, Index unknown, int c) {
  const auto n = static_cast<Index>(box.long_waves.size());
  const Index l = unknown % n, cosine = l, sine = n + l;
  const bool of_cosine = unknown < n;
  const WaveBox::LongWave& wave = box.long_waves[static_cast<std::size_t>(l)];
  if (c == 2) return {part.component(c) * part.vertical * wave.amplitude, of_cosine ? cosine : sine};
  const double factor = part.component(c) * wave.amplitude * wave.direction(c);
  return of_cosine ? LongTerm{factor, sine} : LongTerm{-factor, cosine};
}

MatrixXd long_fields(const WaveBox& box, const PotentialPart& part, int c, const MatrixXd& columns) {
  MatrixXd fields(columns.rows(), columns.cols());
  for (Index u = 0; u < fields.cols(); ++u) {
    const LongTerm term = long_term(box, part, u, c);
    fields.col(u) = term.factor * columns.col(term.column);
  }
  return fields;
}

FieldProduct product_of(const Wave& i, const Wave& j, const Array3d& weights) {
  const double amplitudes = i.amplitude * j.amplitude;
  const double horizontal =
      weights(0) * i.direction.x() * j.direction.x() + weights(1) * i.direction.y() * j.direction.y();
  return {amplitudes * (weights(2) - horizontal), amplitudes * (weights(2) + horizontal)};
}

}  // namespace mstsl
