#include "estimates_output.hpp"

namespace mstsl::app {

namespace fs = std::filesystem;

Result<EstimatesOutput> EstimatesOutput::open(const fs::path& file, const std::optional<fs::path>& tum_file) {
  auto estimates = io::EstimatesWriter::open(file);
  if (!estimates) return estimates.error();
  EstimatesOutput output(std::move(estimates).value());
  if (!tum_file) return output;
  auto tum = io::TumWriter::open(*tum_file);
  if (!tum) return tum.error();
  output.tum_ = std::move(tum).value();
  return output;
}

void EstimatesOutput::write(const Estimate& estimate) {
  if (error_) return;
  keep(estimates_.write(estimate));
  if (tum_ && estimate.map_T_base) keep(tum_->write({estimate.stamp, *estimate.map_T_base}));
}

void EstimatesOutput::close(const io::Summary& summary) {
  keep(estimates_.close(summary));
  if (tum_) keep(tum_->close());
}

void EstimatesOutput::keep(const Result<void>& result) {
  if (!result && !error_) error_ = result.error();
}

}  // namespace mstsl::app
