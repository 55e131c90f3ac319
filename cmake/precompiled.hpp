// The standard and Eigen headers that nearly every file includes, compiled once for all modules (option
// MSTSL_PCH). Files still include what they use: builds without it must pass, too.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>
