#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "campaign/query/verdict_columns.h"
#include "campaign/spec/spec.h"
#include "campaign/store/records.h"

namespace faultsweep {

class LimitSearcher;

/// What became of a row of a design of the campaign.
struct RowAnswers {
  int round = 0;      ///< whose design the row is of.
  long row = 0;       ///< of its round's designs, from 0; 0 where rows are not asked for.
  long position = 0;  ///< of its case, from 1; rows that are the same case share it.
  CaseParameters parameters;
  bool failed = false;     ///< its case has no result: its last run failed.
  bool complete = false;   ///< it has a history to its end.
  std::vector<Held> held;  ///< per question.
};

/// A condition as of `rank --where`, of a fault and a stage where it names none itself.
struct Question {
  std::string condition;
  std::string fault = {};    ///< "" = all faults together.
  std::string stage = {};    ///< "" = the whole history.
  std::string pointer = {};  ///< into the spec, for messages.
};

/// How a campaign goes on.
struct Proposal {
  nlohmann::ordered_json design;  ///< for spec_of_round; null = no further round.
  std::string reason;             ///< why, for people: of the round, or of the end.
};

/// Proposes the rounds of a campaign after its first. A pure function of the spec and the answers:
/// asked again after a kill it proposes the same. A search proposes the values at which its
/// brackets are to be cut; a sample proposes its further points.
class Proposer {
 public:
  virtual ~Proposer() = default;
  /// What it asks of each case.
  virtual std::vector<Question> questions() const = 0;
  /// @param answers  of all rows of all rounds, in their order; every case is decided.
  /// @param designs  of the rounds so far, that of the spec first.
  virtual Proposal propose(const std::vector<RowAnswers>& answers,
                           const std::vector<nlohmann::ordered_json>& designs) const = 0;
  /// The spec of a round after the first, from that of the campaign.
  virtual nlohmann::ordered_json spec_of_round(nlohmann::ordered_json spec,
                                               const nlohmann::ordered_json& design) const = 0;
};

/// The proposer that the spec asks for; null = its design is all there is.
std::unique_ptr<Proposer> make_proposer(const CampaignSpec& spec);
/// The same for a spec of limits. Those of all faults have the names of the base scene's.
LimitSearcher make_limit_searcher(const CampaignSpec& spec);

}  // namespace faultsweep
