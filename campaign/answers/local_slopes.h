#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// What parameters do near one case of a sample in which no two cases differ in one parameter
/// alone: its nearest cases, and the slopes of a plane through them.
namespace faultsweep {

/// The parameters of cases, each as a column with a number per case.
struct ParameterSpace {
  struct Column {
    std::string name;
    std::vector<double>
        values;  ///< SI; of words any numbers that tell them apart. NaN = not there.
    bool is_words = false;
    /// Over all cases; 0 where it does not vary or is words.
    double standard_deviation() const;
  };
  std::vector<Column> columns;
  std::size_t size() const { return columns.empty() ? 0 : columns.front().values.size(); }
};

/// The distance of every case from one of them: √Σ d², with d the difference of a parameter over
/// its standard deviation in the campaign; 1 where words differ or only one of the two has it.
std::vector<double> distances_from(const ParameterSpace& space, std::size_t here);
/// The k nearest ones by those distances, without `here`, the nearest first; of equal ones in their
/// order.
std::vector<std::size_t> nearest(const std::vector<double>& distances, std::size_t here,
                                 std::size_t k);

/// What a standard deviation more of a parameter adds.
struct Slope {
  std::size_t column = 0;  ///< of the ParameterSpace.
  double per_deviation = 0;
  double error = 0;      ///< standard error, from the scatter of the cases about the plane.
  double deviation = 0;  ///< the standard deviation, SI.
};

/// A plane through the cases around one of them.
struct LocalPlane {
  std::vector<Slope> slopes;  ///< of parameters with numbers that vary among those cases.
  std::size_t n_cases = 0;    ///< that it goes by, without the one asked about.
  double radius = 0;          ///< the farthest of them, as distances_from has it.
  double scatter = 0;         ///< standard deviation about the plane, in units of y.
  std::string reason;         ///< why there is none; "" = there is.
};

/// Weighted least squares over the max(20, 3(p + 1)) nearest cases that have the same words, p
/// being the parameters with numbers that vary. Weights fall to 0 just beyond the farthest
/// (tricube: Cleveland, 1979), so that the slope is that at the case as far as the sample tells; a
/// curved response makes it a mean over the neighbourhood. Refused where there are too few cases,
/// or parameters that move together there.
/// @param y  of each case; NaN = has none, and is left out.
LocalPlane local_plane(const ParameterSpace& space, const std::vector<double>& y, std::size_t here);

}  // namespace faultsweep
