#include "simulator/linalg/nested_dissection.h"

#include <metis.h>

#include <array>
#include <csignal>
#include <limits>
#include <numeric>

#include "simulator/common/errors.h"
#include "simulator/common/interrupt.h"

namespace faultsim {
namespace {

using Index = long;

/// METIS 5.1 catches SIGABRT and SIGTERM by System V's signal(), and so puts back handlers that
/// serve once: the next signal would end the process by its default. This puts back what was.
class KeptSignalActions {
 public:
  KeptSignalActions() {
    for (std::size_t i = 0; i < kTaken.size(); ++i) sigaction(kTaken[i], nullptr, &before_[i]);
  }
  ~KeptSignalActions() {
    for (std::size_t i = 0; i < kTaken.size(); ++i) sigaction(kTaken[i], &before_[i], nullptr);
  }
  KeptSignalActions(const KeptSignalActions&) = delete;
  KeptSignalActions& operator=(const KeptSignalActions&) = delete;

 private:
  static constexpr std::array kTaken = {SIGABRT, SIGTERM};
  std::array<struct sigaction, kTaken.size()> before_ = {};
};

/// Both triangles, as METIS wants them; neighbours ascending.
struct Adjacency {
  std::vector<idx_t> begin, neighbours;
};

Adjacency adjacency(const GroupGraph& graph) {
  const idx_t n = static_cast<idx_t>(graph.begin.size()) - 1;
  const std::vector<idx_t> rows(graph.rows.begin(), graph.rows.end());
  Adjacency full;
  full.begin.assign(n + 1, 0);
  const auto for_each_edge = [&](const auto& visit) {  // (j, larger), both ascending
    for (idx_t j = 0; j < n; ++j) {
      for (Index k = graph.begin[j]; k < graph.begin[j + 1]; ++k) visit(j, rows[k]);
    }
  };
  for_each_edge([&](idx_t i, idx_t j) { ++full.begin[i + 1], ++full.begin[j + 1]; });
  std::partial_sum(full.begin.begin(), full.begin.end(), full.begin.begin());
  full.neighbours.resize(2 * rows.size());
  std::vector<idx_t> next(full.begin.begin(), full.begin.end() - 1);
  for_each_edge([&](idx_t i, idx_t j) {
    full.neighbours[next[i]++] = j;
    full.neighbours[next[j]++] = i;
  });
  return full;
}

}  // namespace

std::optional<std::vector<Index>> nested_dissection(const GroupGraph& graph) {
  if (2 * graph.rows.size() > static_cast<std::size_t>(std::numeric_limits<idx_t>::max()))
    return {};
  Adjacency full = adjacency(graph);
  idx_t n = static_cast<idx_t>(full.begin.size()) - 1;
  std::vector<idx_t> order(n), place(n);
  while (true) {
    int done = METIS_ERROR;
    {
      const KeptSignalActions kept;
      done = METIS_NodeND(&n, full.begin.data(), full.neighbours.data(), nullptr, nullptr,
                          order.data(), place.data());
    }
    if (done == METIS_OK) return std::vector<Index>(order.begin(), order.end());
    if (done == METIS_ERROR_MEMORY) return {};
    FAULTSIM_DEMAND(done == METIS_ERROR, "METIS_NodeND returns ", done);
    std::raise(SIGTERM);
    throw_if_interrupted("ordering the unknowns");
  }
}

}  // namespace faultsim
