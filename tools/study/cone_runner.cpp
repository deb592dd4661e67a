#include "study/cone_runner.h"

#include <chrono>
#include <nlohmann/json.hpp>

namespace voxref {

namespace {

/// The parameters of a stage, told apart by what they say as JSON.
std::string voxelize_key(const nlohmann::json& settings) {
  return nlohmann::json{settings.at("grid"), settings.at("voxelize")}.dump();
}

/// All but what the image alone reads.
std::string volume_key(nlohmann::json settings) {
  for (const char* group : {"ao", "gbuffer", "phong", "composite"}) settings.erase(group);
  settings["pixel"] = settings["pixel"]["shadow"] == "visibility";
  settings["cone"].erase("diffuse");
  return settings.dump();
}

}  // namespace

const SurfaceGrid& ConeRunner::surfaces(const Settings& settings) {
  const std::string key = voxelize_key(to_json(settings));
  if (key == surfaces_of_) return surfaces_;
  const auto start = std::chrono::steady_clock::now();
  surfaces_ = voxelize(scene_, fit_grid(scene_.bounds(), settings.grid), settings.voxelize, progress_);
  voxelize_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ran_.voxelize = voxelize_seconds_;
  surfaces_of_ = key;
  return surfaces_;
}

const LitVoxels& ConeRunner::lit(const Settings& settings) {
  const std::string key = volume_key(to_json(settings));
  if (lit_ && key == lit_of_) return *lit_;
  lit_.reset();  // before the next is made: one volume at a time
  lit_ = light_voxels(scene_, caster_, surfaces(settings), view_.background, settings, nullptr, progress_);
  const double voxelizing = ran_.voxelize;
  ran_ = lit_->seconds;
  ran_.voxelize = voxelizing;
  lit_of_ = key;
  return *lit_;
}

ConeTraceResult ConeRunner::operator()(const Settings& settings, const View& view) {
  validate(settings);
  ran_ = {};
  surfaces(settings);
  const LitVoxels& volume = lit(settings);
  ConeTraceResult result = gather_image(scene_, caster_, view, settings, volume, progress_);
  ran_.cone_trace = result.seconds.cone_trace;
  ran_.total += ran_.voxelize + ran_.cone_trace;
  spent_ += ran_.total;
  result.seconds.voxelize = voxelize_seconds_;
  result.seconds.total += voxelize_seconds_;
  return result;
}

}  // namespace voxref
