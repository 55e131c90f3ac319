#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "interrupt.hpp"
#include "mstsl/datasets/cea_corridor.hpp"
#include "mstsl/datasets/dataset_writer.hpp"
#include "mstsl/datasets/kaist.hpp"
#include "progress.hpp"
#include "session.hpp"

namespace mstsl::app {
namespace {

namespace fs = std::filesystem;
