#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "study/study.h"

namespace voxref {

/// Everything in one object: {provenance, studies: [{name, title, command, skipped, sections: [...]}]}
nlohmann::json study_result(std::span<const StudyResult> results, const nlohmann::json& provenance);

/// Writes NAME.csv and NAME.json per table into the folder, which is made when it is not there. Each says the study's
/// command and its section's time, a CSV in a comment before the heading.
/// @param provenance object: version, command_line ... @throws Error with the path of what cannot be written
void write_tables(const std::filesystem::path& folder, const StudyResult& result, const nlohmann::json& provenance);

/// Draws NAME.gnuplot, NAME.svg and NAME.png per chart that holds something; command and time stand above the plot.
void draw_charts(const std::filesystem::path& folder, const StudyResult& result, const std::filesystem::path& gnuplot);

/// Writes result.json: study_result().
void write_result(const std::filesystem::path& folder, std::span<const StudyResult> results,
                  const nlohmann::json& provenance);

/// Writes report.html, which holds all of the results and needs no other file.
/// @param charts whether draw_charts() drew them into the folder
void write_page(const std::filesystem::path& folder, std::span<const StudyResult> results,
                const nlohmann::json& provenance, bool charts);

}  // namespace voxref
