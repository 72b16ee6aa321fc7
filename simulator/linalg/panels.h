#pragma once

#include <vector>

#include "simulator/linalg/supernodes.h"

namespace faultsim {

/// Columns first … first+width−1 of a supernode.
struct Columns {
  long supernode = 0;
  int first = 0, width = 0;
};

/// What some earlier columns owe a panel: L_source[row …] L_source[row … row+n_columns−1]ᵀ is
/// taken off its columns.
struct PanelUpdate {
  Columns source;
  int row = 0;         ///< in the source's list of rows: the first that is a column of the panel.
  int n_columns = 0;   ///< how many are.
  int last_panel = 0;  ///< complete when the source is.
};

/// The work of a left-looking factorisation, from the structure alone.
struct PanelSchedule {
  explicit PanelSchedule(const Supernodes& supernodes);

  /// Tasks for `n_threads`, to be taken in this order: ranges [first, last) of panels, whole
  /// subtrees first, the longest ahead, then panel by panel. A panel needs panels of its own task,
  /// taken before it, or of earlier tasks only.
  struct Task {
    int first = 0, last = 0;
  };
  std::vector<Task> tasks(int n_threads) const;

  std::vector<Columns> panels;       ///< ascending.
  std::vector<long> update_begin;    ///< updates of panel p: [update_begin[p], update_begin[p+1])
  std::vector<PanelUpdate> updates;  ///< by panel, ascending sources; of other supernodes only.
  std::vector<double> flops;         ///< per panel.
  long largest_product = 0;          ///< entries of the largest product of an update.
  int n_panels() const { return static_cast<int>(panels.size()); }
  int first_panel(long supernode) const { return first_panel_[supernode]; }

 private:
  void cut(const Supernodes& supernodes);
  void list_updates(const Supernodes& supernodes);
  void find_subtrees(const Supernodes& supernodes);

  std::vector<int> first_panel_;   ///< per supernode, and one beyond.
  std::vector<long> first_below_;  ///< per supernode: its subtree is [this, s], or −1.
};

}  // namespace faultsim
