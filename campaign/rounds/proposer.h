#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "campaign/spec/spec.h"
#include "campaign/store/records.h"

namespace faultsweep {

/// What became of a row of a design of the campaign.
struct Answer {
  int round = 0;      ///< whose design the row is of.
  long position = 0;  ///< of its case, from 1; rows that are the same case share it.
  CaseParameters parameters;
  bool failed = false;    ///< its case has no result: its last run failed.
  bool complete = false;  ///< it has a history to its end.
  bool holds = false;     ///< complete, and Proposer::condition is true.
};

/// How a campaign goes on.
struct Proposal {
  nlohmann::ordered_json design;  ///< as in a spec, in its order; null = no further round.
  std::string reason;             ///< why, for people: of the round, or of the end.
};

/// Proposes the rounds of a campaign after its first. A pure function of the spec and the answers:
/// asked again after a kill it proposes the same. A search proposes a list design with the values
/// at which its brackets are to be cut; a sample proposes its further points.
class Proposer {
 public:
  virtual ~Proposer() = default;
  /// What it asks of each case, as of `rank --where`.
  virtual std::string condition() const = 0;
  /// @param answers  of all rows of all rounds, in their order; every case is decided.
  /// @param designs  of the rounds so far, that of the spec first.
  virtual Proposal propose(const std::vector<Answer>& answers,
                           const std::vector<nlohmann::ordered_json>& designs) const = 0;
};

/// The proposer that the spec asks for; null = its design is all there is.
std::unique_ptr<Proposer> make_proposer(const CampaignSpec& spec);

}  // namespace faultsweep
