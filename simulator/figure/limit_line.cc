#include "simulator/figure/limit_line.h"

#include <algorithm>

#include "simulator/common/text.h"
#include "simulator/figure/axis.h"

namespace faultsim::figure {
namespace {

enum class Safety { unknown, safe, unsafe };

Safety safety_of(const MapCell& cell, long needed) {
  if (cell.n_slide() + cell.n_undecided() + cell.n_early() > 0) return Safety::unsafe;
  return cell.n_decided() >= needed ? Safety::safe : Safety::unknown;
}

std::string cases_text(long n) {
  return concat(plain_number(static_cast<double>(n), 9),
                n == 1 ? " decided case" : " decided cases");
}

}  // namespace

LimitLine limit_line(const CellGrid& grid) {
  LimitLine limit;
  limit.needed = few_cases(grid);
  const auto safety = [&](int i, int j) { return safety_of(grid.at(i, j), limit.needed); };
  const auto differ = [](Safety a, Safety b) {
    return a != b && a != Safety::unknown && b != Safety::unknown;
  };
  for (int j = 0; j < grid.y.n; ++j) {
    for (int i = 0; i < grid.x.n; ++i) {
      const Safety here = safety(i, j);
      const double right = i + 1, top = j + 1;
      if (i + 1 < grid.x.n && differ(here, safety(i + 1, j)))
        limit.edges.push_back({{right, top - 1}, {right, top}});
      if (j + 1 < grid.y.n && differ(here, safety(i, j + 1)))
        limit.edges.push_back({{right - 1, top}, {right, top}});
      if (here == Safety::unsafe) ++limit.n_unsafe;
      if (here != Safety::safe) continue;
      const long n = grid.at(i, j).n_decided();
      limit.fewest = limit.n_safe++ == 0 ? n : std::min(limit.fewest, n);
    }
  }
  return limit;
}

LimitWords words_of(const LimitLine& limit) {
  const std::string enough = cases_text(limit.needed) + " or more";
  if (!limit.edges.empty()) {
    return {
        "limit: in no cell beyond it does a case slide, nor may one (undecided, ended early)",
        concat("It runs along cells of ", enough, " (the fewest has ",
               plain_number(static_cast<double>(limit.fewest), 9), "); where there are ",
               limit.needed > 1 ? "fewer, as in “0 of 3”, or none" : "none", " there is no line.")};
  }
  if (limit.n_unsafe == 0)
    return {"No limit is drawn: in no cell does a case slide, nor may one.", ""};
  if (limit.n_safe == 0) {
    return {concat("No limit is drawn: each cell of ", enough,
                   " has one that slides, or may (undecided, ended early)."),
            ""};
  }
  return {concat("No limit is drawn: no cell of ", enough,
                 " in which nothing slides, nor may, is beside one in which something does."),
          ""};
}

}  // namespace faultsim::figure
