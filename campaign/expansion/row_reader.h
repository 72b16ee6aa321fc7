#pragma once

#include <string>
#include <vector>

#include "campaign/expansion/case_values.h"
#include "campaign/expansion/scene_builder.h"

namespace faultsweep {

/// A row of a design, and what its scene is.
struct ReadRow {
  Row row;
  std::vector<double> derived;
  int excluded = -1;     ///< by which exclusion.
  std::string identity;  ///< of the case; "" where it is excluded or has problems.
  std::string family;    ///< its fingerprint, where it was asked for.
  std::vector<faultsim::Problem> problems;
};

/// Reads the scenes of all rows of a group one after the other, ahead and on all cores.
class RowReader {
 public:
  RowReader(const CampaignSpec& spec, const Group& group, const CaseValues& values,
            faultsim::Relations relations);
  /// The next row. @param with_family  from the next block of rows on.
  ReadRow& next(bool with_family);

 private:
  void read_block(bool with_family);

  const Group& group_;
  const CaseValues& values_;
  faultsim::Relations relations_;
  std::vector<SceneBuilder> builders_;  ///< per thread.
  std::vector<ReadRow> block_;
  long first_ = 0;        ///< row of the block's first.
  std::size_t next_ = 0;  ///< in the block.
};

}  // namespace faultsweep
