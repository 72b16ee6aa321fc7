#include "campaign/scheduler/progress.h"

#include <cmath>
#include <cstdio>

#include "campaign/store/clock.h"

namespace faultsweep {

namespace {

std::string tail(const Progress& progress) {
  std::string text;
  if (progress.n_failed > 0) text += concat(", ", progress.n_failed, " failed");
  if (progress.seconds_left >= 0 && progress.n_done + progress.n_failed < progress.n_cases) {
    text += ", " + format_duration(progress.seconds_left) + " left";
  }
  if (!progress.doing.empty()) text += ", " + progress.doing;
  return text;
}

double fraction(const Progress& progress) {
  if (progress.n_cases == 0) return 1;
  return static_cast<double>(progress.n_done + progress.n_failed) /
         static_cast<double>(progress.n_cases);
}

}  // namespace

std::string progress_bar(const Progress& progress) {
  constexpr int kWidth = 30;
  const int full = static_cast<int>(std::floor(kWidth * fraction(progress)));
  return "[" + std::string(static_cast<std::size_t>(full), '#') +
         std::string(static_cast<std::size_t>(kWidth - full), '.') + "] " +
         concat(progress.n_done + progress.n_failed, "/", progress.n_cases, " cases") +
         tail(progress);
}

std::string progress_line(const Progress& progress) {
  return concat(progress.n_done + progress.n_failed, " of ", progress.n_cases, " cases (",
                static_cast<int>(std::floor(100 * fraction(progress))), " %)") +
         tail(progress);
}

void ProgressDisplay::show(const Progress& progress) {
  if (style_ == Style::silent) return;
  const double pause = style_ == Style::bar ? kBarSeconds : kLineSeconds;
  if (shown_ && since_shown_.seconds() < pause) return;
  shown_ = true;
  since_shown_ = {};
  if (style_ == Style::bar) {
    std::fprintf(stderr, "\r%s\033[K", progress_bar(progress).c_str());
    drawn_ = true;
  } else {
    std::fprintf(stderr, "%s\n", progress_line(progress).c_str());
  }
  std::fflush(stderr);
}

void ProgressDisplay::note(const std::string& text) {
  if (style_ == Style::silent) return;
  if (drawn_) std::fprintf(stderr, "\r\033[K");
  drawn_ = false;
  std::fprintf(stderr, "%s\n", text.c_str());
  std::fflush(stderr);
}

}  // namespace faultsweep
