#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "study/study.h"

namespace voxref {

/// Everything in one object: {provenance, studies: [{name, title, command, skipped, sections: [...]}]}
nlohmann::json study_result(std::span<const StudyResult> results, const nlohmann::json& provenance);

/// Writes what one study found into the folder, which is made when it is not there: NAME.csv and NAME.json per table;
/// NAME.gnuplot, NAME.svg and NAME.png per chart that holds something, where gnuplot is installed. Each says the
/// study's command and its section's time: a CSV in a comment before the heading, a chart above the plot.
/// @param provenance object: version, command_line ... @throws Error with the path of what cannot be written
void write_study(const std::filesystem::path& folder, const StudyResult& result, const nlohmann::json& provenance,
                 const std::optional<std::filesystem::path>& gnuplot);

/// Writes result.json, and report.html, which holds all of the results and needs no other file.
/// @param charts whether write_study() drew them into the folder
void write_report(const std::filesystem::path& folder, std::span<const StudyResult> results,
                  const nlohmann::json& provenance, bool charts);

}  // namespace voxref
