#include "campaign/expansion/rows.h"

#include <algorithm>
#include <numeric>
#include <random>

#include "campaign/expansion/unit_samples.h"

namespace faultsweep {
namespace {

/// Values of one parameter at points of the unit interval: drawn from its range in this order, or
/// the levels that its list has there.
class Values {
 public:
  Values(Parameter& parameter, const std::vector<double>& points) {
    const auto first = parameter.n_values();
    if (parameter.range) parameter.draw(points);
    const auto n_levels = static_cast<int>(parameter.choices.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      numbers_.push_back(parameter.range
                             ? first + static_cast<int>(i)
                             : std::min(static_cast<int>(points[i] * n_levels), n_levels - 1));
    }
  }
  int operator[](std::size_t point) const { return numbers_[point]; }

 private:
  std::vector<int> numbers_;
};

void correlate(const Design::Correlated& correlated, UnitSamples& columns) {
  std::vector<double> u(correlated.parameters.size());
  for (std::size_t i = 0; i < columns.front().size(); ++i) {
    for (std::size_t k = 0; k < u.size(); ++k) u[k] = columns[correlated.parameters[k]][i];
    correlated.copula.correlate(u);
    for (std::size_t k = 0; k < u.size(); ++k) columns[correlated.parameters[k]][i] = u[k];
  }
}

/// One row per point.
void draw_points(UnitSamples columns, Design& design, Parameter* parameters) {
  const auto n = static_cast<std::size_t>(design.n);
  if (design.correlated) correlate(*design.correlated, columns);
  design.rows.assign(n, std::vector<int>(design.n_parameters));
  for (std::size_t p = 0; p < design.n_parameters; ++p) {
    const Values values(parameters[p], columns[p]);
    for (std::size_t i = 0; i < n; ++i) design.rows[i][p] = values[i];
  }
}

/// Dimensions 0 .. D-1 are sample A, D .. 2D-1 are sample B. Values that are listed are paired at
/// random: the leading binary digits of two dimensions of the sequence may agree in all of the
/// first points, and a parameter with two levels would then never change from A to B.
void draw_sobol(Design& design, Parameter* parameters) {
  const auto n = static_cast<std::size_t>(design.n);
  const std::size_t d = design.n_parameters;
  auto columns = sobol_sequence(n, 2 * d, design.seed);
  const auto paired_at_random = latin_hypercube(n, 2 * d, design.seed);
  for (std::size_t k = 0; k < 2 * d; ++k) {
    if (!parameters[k % d].range) columns[k] = paired_at_random[k];
  }
  std::vector<Values> values;  // points 0 .. n-1 are those of A, the others those of B
  for (std::size_t p = 0; p < d; ++p) {
    columns[p].insert(columns[p].end(), columns[d + p].begin(), columns[d + p].end());
    values.emplace_back(parameters[p], columns[p]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<int> a, b;
    for (const Values& one : values) {
      a.push_back(one[i]);
      b.push_back(one[n + i]);
    }
    const auto add_with = [&](std::vector<int> row, const std::vector<int>& other, std::size_t p) {
      row[p] = other[p];
      design.rows.push_back(std::move(row));
    };
    design.rows.push_back(a);
    for (std::size_t p = 0; p < d; ++p) add_with(a, b, p);
    for (std::size_t p = 0; design.second_order && p < d; ++p) add_with(b, a, p);
    design.rows.push_back(b);
  }
}

void draw_morris(Design& design, Parameter* parameters) {
  const std::size_t d = design.n_parameters;
  const int p = design.levels;
  std::vector<double> ends, parts;  // positions in a range; in a list
  for (int level = 0; level < p; ++level) {
    ends.push_back(static_cast<double>(level) / (p - 1));
    parts.push_back((level + 0.5) / p);
  }
  std::vector<Values> values;
  for (std::size_t k = 0; k < d; ++k) {
    values.emplace_back(parameters[k], parameters[k].range ? ends : parts);
  }
  std::mt19937_64 random(static_cast<std::uint64_t>(design.seed));
  std::vector<std::size_t> order(d);
  for (long t = 0; t < design.n; ++t) {
    std::vector<int> levels(d);
    for (int& level : levels)
      level = static_cast<int>(below(static_cast<std::uint64_t>(p), random));
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t k = d; k > 1; --k) std::swap(order[k - 1], order[below(k, random)]);
    const auto add_row = [&] {
      std::vector<int> row;
      for (std::size_t k = 0; k < d; ++k) {
        row.push_back(values[k][levels[k]]);
      }
      design.rows.push_back(std::move(row));
    };
    add_row();
    for (const std::size_t k : order) {
      levels[k] += levels[k] < p / 2 ? p / 2 : -p / 2;
      add_row();
    }
  }
}

}  // namespace

void draw_sampled_rows(Group& group) {
  Parameter* parameters = group.parameters.data();
  for (Design& design : group.designs) {
    const auto n = static_cast<std::size_t>(design.n);
    if (design.kind == DesignKind::monte_carlo) {
      draw_points(monte_carlo(design.first, n, design.n_parameters, design.seed), design,
                  parameters);
    }
    if (design.kind == DesignKind::latin_hypercube) {
      draw_points(latin_hypercube(n, design.n_parameters, design.seed), design, parameters);
    }
    if (design.kind == DesignKind::sobol) draw_sobol(design, parameters);
    if (design.kind == DesignKind::morris) draw_morris(design, parameters);
    parameters += design.n_parameters;
  }
}

}  // namespace faultsweep
