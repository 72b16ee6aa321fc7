#pragma once

#include <string>

#include "campaign/common/names.h"
#include "simulator/common/stopwatch.h"

namespace faultsweep {

/// How far a campaign is.
struct Progress {
  long n_cases = 0, n_done = 0, n_failed = 0;
  double seconds_left = 0;  ///< predicted; < 0 = not known.
  std::string doing;        ///< "building 2 operators".
};

/// "[#####.....] 120/240 cases, 3 failed, 2 min 10 s left, building 1 operator".
std::string progress_bar(const Progress& progress);
/// The same without the bar, for logs: "120 of 240 cases (50 %), ...".
std::string progress_line(const Progress& progress);

/// Shows progress on stderr: a bar redrawn in place on a terminal, a line now and then elsewhere.
class ProgressDisplay {
 public:
  enum class Style { silent, lines, bar };
  friend constexpr auto words(Style) { return std::array{"none", "lines", "bar"}; }
  explicit ProgressDisplay(Style style) : style_(style) {}
  void show(const Progress& progress);
  /// The last word, always shown; ends the bar's line.
  void finish(const Progress& progress) { note(progress_line(progress)); }
  /// A remark between.
  void note(const std::string& text);

  static constexpr double kBarSeconds = 0.2;
  static constexpr double kLineSeconds = 10;

 private:
  Style style_;
  bool drawn_ = false;
  bool shown_ = false;
  faultsim::Stopwatch since_shown_;
};

}  // namespace faultsweep
