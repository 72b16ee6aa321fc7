#pragma once

#include "campaign/rounds/limit_search.h"
#include "campaign/rounds/proposer.h"

namespace faultsweep {

/// Searches the limits that a spec asks for: per row of its design (a *configuration*), per
/// parameter and per fault. All of them are searched at once, a case of a round for each crossing
/// that is still too wide; cases that several of them ask for are one.
///
/// The answers' rows are those of the design with the values of its round in each of its rows (see
/// Design::without_base), and RowAnswers::held has for each fault of each limit whether it is
/// unsafe.
class LimitSearcher final : public Proposer {
 public:
  /// @param limits  with all their faults named.
  explicit LimitSearcher(std::vector<LimitSearch> limits) : limits_(std::move(limits)) {}
  std::vector<Question> questions() const override;
  Proposal propose(const std::vector<RowAnswers>& answers,
                   const std::vector<nlohmann::ordered_json>& designs) const override;
  nlohmann::ordered_json spec_of_round(nlohmann::ordered_json spec,
                                       const nlohmann::ordered_json& design) const override;

  /// What is known of a limit and fault of a configuration.
  struct Search {
    long configuration = 0;  ///< row of the spec's design, from 0.
    std::size_t limit = 0;   ///< of limits().
    std::size_t fault = 0;   ///< of its faults.
    LimitFinding finding;
  };
  /// In the order of configurations, limits and faults.
  std::vector<Search> search(const std::vector<RowAnswers>& answers,
                             const std::vector<nlohmann::ordered_json>& designs) const;
  const std::vector<LimitSearch>& limits() const { return limits_; }

 private:
  struct Value;
  std::vector<std::vector<Value>> values_of_rounds(
      const std::vector<nlohmann::ordered_json>& designs) const;

  std::vector<LimitSearch> limits_;
};

}  // namespace faultsweep
