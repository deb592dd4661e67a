#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "progress.h"
#include "scene/caster.h"
#include "scene/scene.h"
#include "settings.h"
#include "study/chart.h"
#include "study/table.h"

namespace voxref {

/// What one question was answered with.
struct Section {
  std::string title;
  std::string text;  ///< paragraphs, an empty line between them: what was done, what it shows
  std::vector<Table> tables;
  std::vector<Chart> charts;
  double seconds = 0;                   ///< that it took
  std::vector<std::string> warnings{};  ///< what is wrong with its numbers
};

struct StudyResult {
  std::string name, title;
  std::vector<Section> sections{};
  std::vector<std::string> skipped{};  ///< what was left out, and why
  std::string command{};               ///< that makes this study alone; the caller's to fill in
};

/// A scene with the camera that studies look through.
struct StudyScene {
  std::string name;
  Scene scene;
  View view;  ///< its size is the study's to choose; the camera's aspect holds
};

/// What a study is asked for.
struct StudyRequest {
  bool quick = false;                ///< small sizes: minutes instead of an hour
  std::vector<StudyScene> scenes;    ///< for studies that take them; empty: the study's own
  std::filesystem::path assets;      ///< folder that holds assets/, the larger public scenes; empty: there are none
  std::optional<Settings> settings;  ///< that `ladder` goes on to; none: the published ones
  std::optional<Image> users_image;  ///< somebody else's rendering of the (single) scene, for `ladder`
  Progress progress;
};

/// The progress of a part: what it reports says whose part it is, "part, stage".
Progress inside(const Progress& whole, const std::string& part);

/// Calls `make`, which fills a section, and notes the time.
Section timed_section(const std::string& title, const std::function<void(Section&)>& make);

struct Study {
  std::string name, sentence;
  StudyResult (*run)(const StudyRequest& request);
  bool takes_scenes = false;    ///< in place of its own
  bool takes_settings = false;  ///< and somebody else's rendering
};

/// All studies, in the order in which `all` runs them.
std::span<const Study> studies();

StudyResult run_pareto(const StudyRequest& request);
StudyResult run_ladder(const StudyRequest& request);
StudyResult run_thesis(const StudyRequest& request);
StudyResult run_stability(const StudyRequest& request);

}  // namespace voxref
