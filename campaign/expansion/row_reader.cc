#include "campaign/expansion/row_reader.h"

#include <algorithm>
#include <future>
#include <thread>

#include "simulator/plan/plan.h"

namespace faultsweep {
namespace {

constexpr long kFirstBlock = 256;  ///< rows: after it is known whether families are many.
constexpr long kBlock = 4096;
constexpr unsigned kMostThreads = 8;

void read_row(const CaseValues& values, faultsim::Relations relations, bool with_family,
              SceneBuilder& builder, ReadRow& one) {
  values.derive(one.row, one.derived);
  one.excluded = values.excluded_by(one.row, one.derived);
  if (one.excluded >= 0) return;
  const auto* changed = builder.scene(one.row, one.derived, relations, one.problems);
  if (changed == nullptr) return;
  one.identity = faultsim::case_identity(changed->canonical);
  if (with_family) one.family = faultsim::family_of(changed->scene);
}

}  // namespace

RowReader::RowReader(const CampaignSpec& spec, const Group& group, const CaseValues& values,
                     faultsim::Relations relations)
    : group_(group), values_(values), relations_(relations) {
  const unsigned n = std::clamp(std::thread::hardware_concurrency(), 1U, kMostThreads);
  for (unsigned i = 0; i < n; ++i) builders_.emplace_back(spec, group);
}

ReadRow& RowReader::next(bool with_family) {
  if (next_ == block_.size()) read_block(with_family);
  return block_[next_++];
}

/// Each thread reads neighbours, which differ least.
void RowReader::read_block(bool with_family) {
  first_ += static_cast<long>(block_.size());
  const long size = std::min(first_ == 0 ? kFirstBlock : kBlock, count_rows(group_) - first_);
  FAULTSIM_DEMAND(size > 0, "row ", first_);
  block_.assign(static_cast<std::size_t>(size), {});
  next_ = 0;
  const std::size_t n = builders_.size();
  std::vector<std::future<void>> shares;
  for (std::size_t k = 0; k < n; ++k) {
    shares.push_back(std::async(std::launch::async, [this, k, n, with_family] {
      for (std::size_t i = k * block_.size() / n; i < (k + 1) * block_.size() / n; ++i) {
        row_at(group_, first_ + static_cast<long>(i), block_[i].row);
        read_row(values_, relations_, with_family, builders_[k], block_[i]);
      }
    }));
  }
  for (std::future<void>& share : shares) share.get();
}

}  // namespace faultsweep
