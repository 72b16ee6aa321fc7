#pragma once

#include "campaign/rounds/proposer.h"

namespace faultsweep {

/// Draws further samples of a monte-carlo design until the interval of a probability is narrow
/// enough, or there are as many as allowed. A sample that cells or stated errors leave undecided,
/// whose case failed, or whose history ends early, may be either: the interval reaches from none of
/// these to all of them. More samples do not narrow that part. So what is narrow enough is the
/// interval of what was computed.
///
/// A round has what is missing if the share stays as it is, at most as many samples as there are
/// and at least a tenth. The confidence is that of one interval; as the end is chosen by looking at
/// it, its coverage is slightly less, the less the more samples the first round has.
class StagedSampler final : public Proposer {
 public:
  explicit StagedSampler(const StagedSample& wanted) : wanted_(wanted) {}
  std::vector<Question> questions() const override {
    return {{.condition = wanted_.condition, .pointer = "/rounds/probability_of"}};
  }
  Proposal propose(const std::vector<RowAnswers>& answers,
                   const std::vector<nlohmann::ordered_json>& designs) const override;
  nlohmann::ordered_json spec_of_round(nlohmann::ordered_json spec,
                                       const nlohmann::ordered_json& design) const override;

 private:
  StagedSample wanted_;
};

}  // namespace faultsweep
