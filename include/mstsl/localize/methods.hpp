#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "mstsl/core/result.hpp"
#include "mstsl/localize/baselines/global_scan.hpp"
#include "mstsl/localize/baselines/mag_filter.hpp"
#include "mstsl/localize/baselines/mcl.hpp"
#include "mstsl/localize/joint/joint.hpp"
#include "mstsl/localize/localization_maps.hpp"
#include "mstsl/localize/localizer.hpp"
#include "mstsl/localize/two_step.hpp"

namespace mstsl {

/// The ways to localize that a user can name.
std::vector<std::string> method_names();

/// The options of all methods; each reads its own.
struct MethodOptions {
  TwoStepOptions two_step;
  JointOptions joint;
  GlobalScanOptions global_scan;
  MagFilterOptions mag_filter;
  MclOptions mcl;
  Threads threads;
};

/// A method made ready for a place: gives a localizer for each run there. May be called from many threads.
using LocalizerFactory = std::function<AnyLocalizer(const Rig&)>;

/// Errors: a name that is not in method_names(), options that make no sense.
Result<LocalizerFactory> make_method(std::string_view name, std::shared_ptr<const LocalizationMaps> maps,
                                     const MethodOptions& options = {});

}  // namespace mstsl
