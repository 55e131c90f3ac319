#include "mstsl/localize/estimate.hpp"

namespace mstsl {

std::string_view to_string(LocalizationStatus status) {
  switch (status) {
    case LocalizationStatus::kSearching:
      return "searching";
    case LocalizationStatus::kLocalized:
      return "localized";
    case LocalizationStatus::kLost:
      return "lost";
  }
  return "searching";
}

}  // namespace mstsl
