#include "simulator/common/near_miss.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <span>

#include "simulator/common/text.h"

namespace faultsim {
namespace {

std::string folded(const std::string& word) {
  std::string result;
  for (const char letter : word) {
    const auto lower = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    result += lower == '-' || lower == ' ' ? '_' : lower;
  }
  return result;
}

}  // namespace

std::size_t edit_distance(const std::string& a, const std::string& b) {
  const std::size_t n = b.size() + 1;
  std::vector<std::size_t> before(n);
  std::vector<std::size_t> last(n);
  std::vector<std::size_t> now(n);
  for (std::size_t j = 0; j < n; ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j < n; ++j) {
      const std::size_t replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(now);
  }
  return last[n - 1];
}

std::string near_miss(const std::string& word, const std::vector<std::string>& candidates) {
  // Nobody mistypes a word of this length, and the distance takes the product of both.
  constexpr std::size_t kLongestWord = 100;
  constexpr std::size_t kMostCandidates = 300;
  if (word.size() > kLongestWord) return "";
  const std::string wanted = folded(word);
  std::string best;
  std::size_t best_distance = 0;
  const std::size_t n = std::min(candidates.size(), kMostCandidates);
  for (std::size_t i = 0; i < n; ++i) {
    const std::string& candidate = candidates[i];
    const std::size_t limit = std::max(word.size(), candidate.size()) / 3;
    const std::size_t longer = std::max(word.size(), candidate.size());
    if (longer - std::min(word.size(), candidate.size()) > limit) continue;  // d is at least that
    const std::size_t d = edit_distance(wanted, folded(candidate));
    if (d > limit) continue;
    if (best.empty() || d < best_distance) {
      best = candidate;
      best_distance = d;
    }
  }
  return best;
}

std::string suggest(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string near = near_miss(word, candidates);
  if (!near.empty()) return "did you mean \"" + near + "\"?";
  if (candidates.empty()) return "remove it";
  constexpr std::size_t kMostListed = 60;
  const std::string text =
      (candidates.size() == 1 ? "write \"" : "write one of \"") +
      joined(std::span(candidates).first(std::min(candidates.size(), kMostListed)), "\", \"") +
      "\"";
  return candidates.size() > kMostListed ? text + ", ..." : text;
}

}  // namespace faultsim
