#pragma once

#include <concepts>
#include <memory>
#include <utility>

#include "mstsl/core/sensor_data.hpp"
#include "mstsl/localize/estimate.hpp"
#include "mstsl/localize/report.hpp"

namespace mstsl {

/// Anything that is fed a robot's readings in time order and can be asked where the robot is. The two-step
/// method, the joint one and every baseline are interchangeable here. An estimate carries the stamp of the
/// last scan that was processed; a localizer may pass over scans that tell it nothing new.
template <typename L>
concept Localizer = requires(L localizer, const L& asked, const OdometryReading& odometry,
                             const OdometryRestart& restart, const LaserScan& scan,
                             const FieldReading& field) {
  localizer.observe(odometry);
  localizer.observe(restart);
  localizer.observe(scan);
  localizer.observe(field);
  { asked.estimate() } -> std::same_as<Estimate>;
  { asked.report() } -> std::same_as<LocalizerReport>;
};

/// A Localizer chosen at run time, held by value.
class AnyLocalizer {
 public:
  template <Localizer L>
  explicit AnyLocalizer(L localizer) : self_(std::make_unique<Model<L>>(std::move(localizer))) {}

  void observe(const OdometryReading& odometry) { self_->observe(odometry); }
  void observe(const OdometryRestart& restart) { self_->observe(restart); }
  void observe(const LaserScan& scan) { self_->observe(scan); }
  void observe(const FieldReading& field) { self_->observe(field); }
  Estimate estimate() const { return self_->estimate(); }
  LocalizerReport report() const { return self_->report(); }

 private:
  struct Interface {
    virtual ~Interface() = default;
    virtual void observe(const OdometryReading&) = 0;
    virtual void observe(const OdometryRestart&) = 0;
    virtual void observe(const LaserScan&) = 0;
    virtual void observe(const FieldReading&) = 0;
    virtual Estimate estimate() const = 0;
    virtual LocalizerReport report() const = 0;
  };
  template <Localizer L>
  struct Model final : Interface {
    explicit Model(L l) : localizer(std::move(l)) {}
    void observe(const OdometryReading& odometry) override { localizer.observe(odometry); }
    void observe(const OdometryRestart& restart) override { localizer.observe(restart); }
    void observe(const LaserScan& scan) override { localizer.observe(scan); }
    void observe(const FieldReading& field) override { localizer.observe(field); }
    Estimate estimate() const override { return localizer.estimate(); }
    LocalizerReport report() const override { return localizer.report(); }
    L localizer;
  };
  std::unique_ptr<Interface> self_;
};

static_assert(Localizer<AnyLocalizer>);

/// Hands one event to a localizer; readings that no localizer may see (IMU rates, true poses) are passed
/// over.
template <Localizer L>
void feed(L& localizer, const SensorEvent& event) {
  std::visit(
      [&localizer](const auto& reading) {
        if constexpr (requires { localizer.observe(reading); }) localizer.observe(reading);
      },
      event);
}

}  // namespace mstsl
