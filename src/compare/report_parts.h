#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "compare/causes.h"
#include "compare/comparison_page.h"
#include "compare/noise_verdict.h"

namespace voxref {

// What reports have in common.

/// Makes the folder where it is not there. @throws Error with the path
void make_folder(const std::filesystem::path& folder);

/// Six digits; "infinite", or "undefined" for NaN.
std::string number_text(double value);

/// The last part of a path, of a folder "dumps/a/" too.
std::string name_of(const std::filesystem::path& path);

PageTone tone_of(Verdict verdict);
std::string verdict_words(Verdict verdict);

}  // namespace voxref
