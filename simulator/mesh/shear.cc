#include "simulator/mesh/shear.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

double part(const BentPlane& plane, size_t d, double x) {
  return plane.slope[d] * (std::clamp(x, plane.low[d], plane.high[d]) - plane.pivot[d]);
}

/// Least of part(b) − part(a) over a range: at one of the kinks or ends, as it is piecewise linear.
double least_difference(const BentPlane& a, const BentPlane& b, size_t d,
                        const std::array<double, 2>& range) {
  double least = std::numeric_limits<double>::infinity();
  for (const double x : {range[0], range[1], a.low[d], a.high[d], b.low[d], b.high[d]}) {
    const double inside = std::clamp(x, range[0], range[1]);
    least = std::min(least, part(b, d, inside) - part(a, d, inside));
  }
  return least;
}

}  // namespace

double BentPlane::shift(double b, double c) const { return part(*this, 0, b) + part(*this, 1, c); }

Shear::Shear(double from, double to, std::vector<BentPlane> planes)
    : from_(from), to_(to), planes_(std::move(planes)) {
  double last = from;
  for (const BentPlane& plane : planes_) {
    FAULTSIM_DEMAND(plane.ref > last && plane.ref < to, plane.ref, " ", last, " ", to);
    last = plane.ref;
  }
}

void Shear::shifts(const std::vector<double>& ref, double b, double c,
                   std::vector<double>& out) const {
  out.resize(ref.size());
  double left = from_, left_shift = 0;
  size_t i = 0;
  for (size_t k = 0; k <= planes_.size(); ++k) {
    const bool is_side = k == planes_.size();
    const double right = is_side ? to_ : planes_[k].ref;
    const double right_shift = is_side ? 0 : planes_[k].shift(b, c);
    for (; i < ref.size() && (is_side || ref[i] <= right); ++i) {
      const double t = (ref[i] - left) / (right - left);
      out[i] = left_shift * (1 - t) + right_shift * t;
    }
    left = right;
    left_shift = right_shift;
  }
}

int Shear::first_squeezed_gap(const std::array<double, 2>& range_b,
                              const std::array<double, 2>& range_c) const {
  BentPlane side;  // flat: no slope
  for (size_t k = 0; k <= planes_.size(); ++k) {
    const BentPlane& left = k == 0 ? side : planes_[k - 1];
    const BentPlane& right = k == planes_.size() ? side : planes_[k];
    const double width = (k == planes_.size() ? to_ : right.ref) - (k == 0 ? from_ : left.ref);
    const double least = width + least_difference(left, right, 0, range_b) +
                         least_difference(left, right, 1, range_c);
    if (least < kLeastGap * width) return static_cast<int>(k);
  }
  return -1;
}

}  // namespace faultsim
