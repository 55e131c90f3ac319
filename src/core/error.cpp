#include "mstsl/core/result.hpp"

namespace mstsl {

Error Error::within(std::string_view place) const { return Error(std::string(place) + ": " + message_); }

}  // namespace mstsl
