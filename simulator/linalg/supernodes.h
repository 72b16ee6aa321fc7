#pragma once

namespace faultsim {

/// A supernodal factor L as it lies in memory (CHOLMOD's layout): columns begin[s] … begin[s+1]−1
/// are a dense column-major block from values[value_begin[s]] over the rows
/// rows[row_begin[s]] … rows[row_begin[s+1]−1], the first of which are the columns themselves.
struct Supernodes {
  long n = 0, count = 0;
  const long *begin = nullptr, *row_begin = nullptr, *value_begin = nullptr, *rows = nullptr;
  const double* values = nullptr;

  long width(long s) const { return begin[s + 1] - begin[s]; }
  long height(long s) const { return row_begin[s + 1] - row_begin[s]; }
  const long* rows_of(long s) const { return rows + row_begin[s]; }
};

}  // namespace faultsim
