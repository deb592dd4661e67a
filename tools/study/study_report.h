#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "study/study.h"

namespace voxref {

/// Everything in one object: {provenance, studies: [{name, title, skipped, sections: [...]}]}
nlohmann::json study_result(std::span<const StudyResult> results, const nlohmann::json& provenance);

/// Writes into the folder, which is made when it is not there: NAME.csv and NAME.json per table; NAME.gnuplot, NAME.svg
/// and NAME.png per chart where gnuplot is installed; result.json; and report.html, which holds all of it and needs no
/// other file. @param provenance object: version, command_line ... @throws Error with the path of what cannot be
/// written
void write_studies(const std::filesystem::path& folder, std::span<const StudyResult> results,
                   const nlohmann::json& provenance, const std::optional<std::filesystem::path>& gnuplot);

}  // namespace voxref
