#pragma once
#include <atomic>
#include <functional>
#include <string_view>

#include "error.h"

namespace voxref {

/// What a long computation tells its caller, and asks of it. Cheap to copy. Every member may be called from any thread.
struct Progress {
  /// Called with the stage's name and the finished fraction of it in [0,1]; empty: nobody listens.
  std::function<void(std::string_view stage, double fraction)> report;
  /// Set by the caller to end the computation soon; null: never.
  const std::atomic<bool>* cancel = nullptr;

  void operator()(std::string_view stage, double fraction) const {
    if (report) report(stage, fraction);
  }
  bool cancelled() const { return cancel && cancel->load(std::memory_order_relaxed); }
  /// @throws Interrupted when the caller asked to stop
  void check() const {
    if (cancelled()) throw Interrupted();
  }
};

}  // namespace voxref
