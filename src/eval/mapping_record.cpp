#include "mapping_record.hpp"

#include <exception>
#include <string>

namespace mstsl {

nlohmann::ordered_json json_of(const MappingRecord& r) {
  return {{"robot", r.robot},
          {"world", r.world},
          {"run", r.run},
          {"with_field", r.with_field},
          {"driven_m", r.driven_m},
          {"closures", r.closures},
          {"wrong_closures", r.wrong_closures},
          {"refuted", r.refuted},
          {"ambiguous", r.ambiguous},
          {"refused_by_field", r.refused_by_field},
          {"closed_only_with_field", r.closed_only_with_field},
          {"ate_rms_m", r.ate_rms_m},
          {"ate_max_m", r.ate_max_m},
          {"map_error", r.map_error},
          {"cpu_s", r.cpu_s},
          {"driven_s", r.driven_s}};
}

Result<MappingRecord> mapping_record_from(const nlohmann::ordered_json& j) {
  try {
    MappingRecord r;
    r.robot = j.at("robot");
    r.world = j.at("world");
    r.run = j.at("run");
    r.with_field = j.at("with_field");
    r.driven_m = j.at("driven_m");
    r.closures = j.at("closures");
    r.wrong_closures = j.at("wrong_closures");
    r.refuted = j.at("refuted");
    r.ambiguous = j.at("ambiguous");
    r.refused_by_field = j.at("refused_by_field");
    r.closed_only_with_field = j.at("closed_only_with_field");
    r.ate_rms_m = j.at("ate_rms_m");
    r.ate_max_m = j.at("ate_max_m");
    r.map_error = j.at("map_error");
    r.cpu_s = j.at("cpu_s");
    r.driven_s = j.at("driven_s");
    return r;
  } catch (const std::exception& error) {
    return Error(std::string("not a mapping record: ") + error.what());
  }
}

}  // namespace mstsl
