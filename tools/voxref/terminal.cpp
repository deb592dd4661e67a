#include "terminal.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <mutex>
#include <nlohmann/json.hpp>

namespace voxref {

namespace {

std::atomic<bool> interrupted = false;
std::atomic<int64_t> interrupted_at = 0;  // nanoseconds of the monotonic clock
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int64_t>::is_always_lock_free,
              "else a signal handler must not touch them");

/// The first signal asks the work to stop, a second one ends the program. `timeout -s INT` sends one to the process and
/// to its group at once, so what follows within a second is still the first.
void interrupt(int signal) {
  constexpr int64_t second = 1'000'000'000;
  timespec clock = {};
  clock_gettime(CLOCK_MONOTONIC, &clock);
  const int64_t now = clock.tv_sec * second + clock.tv_nsec;
  if (!interrupted.exchange(true)) {
    interrupted_at = now;
  } else if (now - interrupted_at > second) {
    ::signal(signal, SIG_DFL);
    raise(signal);
  }
}

std::string duration(double seconds) {
  const long long total = std::llround(seconds);
  if (total < 60) return fmt::format("{} s", total);
  if (total < 3600) return fmt::format("{}:{:02} min", total / 60, total % 60);
  return fmt::format("{}:{:02} h", total / 3600, total / 60 % 60);
}

}  // namespace

void catch_interrupt() {
  struct sigaction action = {};
  action.sa_handler = interrupt;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);  // how schedulers ask a job to end
}

/// The line that tells how far the work is.
class Terminal::Bar {
 public:
  void update(std::string_view stage, double fraction) {
    const Seconds now = since_start();
    if (now.count() < next_.load(std::memory_order_relaxed)) return;  // called often, from many threads
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || now.count() < next_.load(std::memory_order_relaxed)) return;
    next_.store(now.count() + (interactive_ ? 0.1 : 4.0), std::memory_order_relaxed);
    constexpr double disorder = 0.05;  // threads report slightly out of order; a step further back is a new beginning
    if (stage != stage_ || fraction < fraction_ - disorder) {
      stage_ = stage;
      stage_begin_ = now;
      fraction_begin_ = fraction;
    }
    fraction_ = fraction;
    draw(fraction, now);
  }

  void clear() {
    if (interactive_ && drawn_) std::fputs("\r\033[K", stderr);
    drawn_ = false;
  }

 private:
  using Seconds = std::chrono::duration<double>;
  Seconds since_start() const { return std::chrono::steady_clock::now() - start_; }

  void draw(double fraction, Seconds now) {
    fraction = std::clamp(fraction, 0.0, 1.0);
    // Judged by the pace since this stage was first seen; said once a part of the stage has passed to judge by.
    const double seen = fraction - fraction_begin_;
    const double left = seen > 0.01 ? (now - stage_begin_).count() * (1 - fraction) / seen : -1;
    const std::string rest = left < 0 ? "" : ", " + duration(left) + " left";
    const int percent = static_cast<int>(100 * fraction);
    if (interactive_) {
      constexpr size_t width = 30;
      const size_t filled = static_cast<size_t>(fraction * width);
      fmt::print(stderr, "\r\033[K{:<12} [{}{}] {:>3} %{}", stage_, std::string(filled, '#'),
                 std::string(width - filled, '.'), percent, rest);
      std::fflush(stderr);
    } else {
      fmt::print(stderr, "{}: {} %{}\n", stage_, percent, rest);
    }
    drawn_ = true;
  }

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const bool interactive_ = isatty(STDERR_FILENO) == 1;
  std::mutex mutex_;
  std::atomic<double> next_ = 1.0;  // seconds from the start: quick work shows nothing
  std::string stage_;
  Seconds stage_begin_{0};
  double fraction_begin_ = 0, fraction_ = 0;
  bool drawn_ = false;
};

Terminal::Terminal(const CommonOptions& options) : options_(options) {
  if (!options.quiet) bar_ = std::make_unique<Bar>();
}
Terminal::~Terminal() {
  if (bar_) bar_->clear();
}

Progress Terminal::progress() {
  Progress progress;
  progress.cancel = &interrupted;
  if (bar_)
    progress.report = [bar = bar_.get()](std::string_view stage, double fraction) { bar->update(stage, fraction); };
  return progress;
}

void Terminal::say(const std::string& line) {
  if (options_.quiet) return;
  bar_->clear();
  fmt::print(options_.json ? stderr : stdout, "{}\n", line);
}

void Terminal::warn(const std::string& line) {
  if (options_.quiet) return;
  bar_->clear();
  fmt::print(stderr, "{}\n", line);
}

void Terminal::result(const nlohmann::json& json) {
  if (bar_) bar_->clear();
  // Names in a scene may hold any bytes; JSON is UTF-8.
  if (options_.json) fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace voxref
