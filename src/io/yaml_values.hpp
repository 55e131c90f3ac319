#pragma once

#include <cmath>
#include <string>

#include <yaml-cpp/yaml.h>

#include "file_problem.hpp"

/// Values out of a yaml, or a FileProblem that names key and line.
namespace mstsl::io {

template <typename T>
T yaml_as(const YAML::Node& node, const char* key, const char* kind) {
  try {
    return node.as<T>();
  } catch (const YAML::Exception&) {
    throw FileProblem("'{}' (line {}) is not {}", key, node.Mark().line + 1, kind);
  }
}

inline double yaml_finite_number(const YAML::Node& node, const char* key) {
  const double value = yaml_as<double>(node, key, "a number");
  if (!std::isfinite(value))
    throw FileProblem("'{}' (line {}) is {}, not a finite number", key, node.Mark().line + 1, value);
  return value;
}

/// What `parse` makes of a text's root. What the parser quotes of a bad one may be the middle of a binary
/// file.
template <typename Parse>
auto parse_yaml(const std::string& text, Parse&& parse) {
  try {
    return parse(YAML::Load(text));
  } catch (const YAML::Exception& problem) {
    std::string message = problem.msg;
    for (char& c : message)
      if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = '?';
    throw FileProblem("line {} is not yaml: {}", problem.mark.line + 1, message);
  }
}

}  // namespace mstsl::io
