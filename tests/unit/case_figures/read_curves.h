#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "simulator/figure/palette.h"
#include "tests/unit/figure/svg_reader.h"

/// Curves as a reader takes them off a drawing.
namespace faultsim {

/// Values of a line of those in a stroke's colour, as the k-th x or y scale of the drawing gives
/// them.
inline std::vector<double> read_line(const std::string& svg, const figure::Stroke& stroke,
                                     bool along_x, std::size_t line, std::size_t scale) {
  const figure::ReadScale read = figure::read_scale(svg, along_x, scale);
  const auto lines = figure::elements_of(svg, "polyline", "stroke", stroke.colour);
  std::vector<double> values;
  for (const figure::Point& one : lines.at(line).points())
    values.push_back(read.value(along_x ? one.x : one.y));
  return values;
}

inline std::vector<double> read_off(const std::string& svg, std::size_t colour, bool along_x,
                                    std::size_t line = 0, std::size_t scale = 0) {
  return read_line(svg, figure::fault_stroke(colour), along_x, line, scale);
}

inline void expect_values(const std::vector<double>& read, const std::vector<double>& given,
                          double error) {
  ASSERT_EQ(read.size(), given.size());
  for (std::size_t k = 0; k < read.size(); ++k) EXPECT_NEAR(read[k], given[k], error) << k;
}

/// The thin line of a curve, as read off the drawing's scales.
inline std::vector<double> read_thin(const std::string& svg, std::size_t colour, bool along_x,
                                     std::size_t line = 0, std::size_t scale = 0) {
  return read_line(svg, figure::before_stroke(colour), along_x, line, scale);
}

}  // namespace faultsim
