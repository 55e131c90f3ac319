#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string_view>

#include "mstsl/magnetic/field_map.hpp"

namespace mstsl {

/// What the paper reports of one of its two places (Table I, Fig. 6 and the text of section IV-C).
struct PaperFigures {
  struct Initialisation {
    double mean_m, sd_m, min_m, max_m, success;
  };
  std::map<FieldModel, Initialisation> initialisation;
  double alignment_mean_deg;
  double success;            ///< of the whole method, with GPR
  double error_m;            ///< this error ...
  double error_share;        ///< ... is not exceeded by this share of the runs
  std::size_t fingerprints;  ///< of its survey
};

/// Of the place that a simulated world stands for; nothing for the others.
inline std::optional<PaperFigures> paper_figures(std::string_view world) {
  if (world == "corridor")
    return PaperFigures{{{FieldModel::kFingerprint, {1.232, 0.721, 0.32, 4.75, 0.82}},
                         {FieldModel::kBilinear, {1.15, 0.544, 0.26, 4.54, 0.87}},
                         {FieldModel::kGpr, {0.852, 0.502, 0.13, 3.97, 0.96}}},
                        1.23,
                        0.96,
                        0.6,
                        0.96,
                        67'238};
  if (world == "carpark")
    return PaperFigures{{{FieldModel::kFingerprint, {2.251, 0.534, 1.35, 4.95, 0.76}},
                         {FieldModel::kBilinear, {2.015, 0.362, 1.28, 4.76, 0.82}},
                         {FieldModel::kGpr, {1.832, 0.483, 1.2, 4.61, 0.93}}},
                        1.19,
                        0.92,
                        1.5,
                        0.80,
                        118'688};
  return std::nullopt;
}

}  // namespace mstsl
