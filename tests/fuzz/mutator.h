#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <vector>

namespace faultsim {

/// Makes wrong inputs out of right ones, by a seed: the same corpus and seed give the same text.
class Mutator {
 public:
  Mutator(const std::vector<std::string>& corpus, unsigned long seed);

  /// A text of the corpus with one to four changes. JSON is changed as a document (values of
  /// another kind, size or unit, keys misspelt, elements repeated or lost, parts of other texts put
  /// in), two in ten texts and all that is not JSON as bytes.
  std::string json();
  std::string bytes();

 private:
  std::size_t below(std::size_t n);
  const std::string& pick(const std::vector<std::string>& list) { return list[below(list.size())]; }
  std::string changed_bytes(std::string text);

  const std::vector<std::string>& corpus_;
  std::mt19937_64 random_;
};

}  // namespace faultsim
