// Localizes a log with the library: the whole program a user needs.
#include <cstdio>
#include <memory>
#include <optional>

#include "mstsl/io/field_map_file.hpp"
#include "mstsl/io/map_server.hpp"
#include "mstsl/io/recording.hpp"
#include "mstsl/localize/localization_maps.hpp"
#include "mstsl/localize/two_step.hpp"
