#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "campaign/expansion/expansion.h"
#include "campaign/expansion/rows.h"
#include "campaign/expansion/unit_samples.h"
#include "simulator/common/stopwatch.h"
#include "simulator/reading/read_scene.h"
#include "tests/unit/expansion/long_way.h"

/// Rows of Latin hypercube, Sobol' and Morris designs, checked by what defines each of them.
namespace faultsweep {
namespace {

using ::testing::ElementsAre;

constexpr const char* kThree = R"("parameters": {
    "friction_angle": {"from": "15 deg", "to": "35 deg"},
    "cohesion": {"from": "1 bar", "to": "4 MPa"},
    "biot": {"from": 0.5, "to": 1}})";

Expansion expand_kind(const std::string& kind_and_numbers, const std::string& parameters = kThree) {
  return expand_design(R"({"kind": )" + kind_and_numbers + ", " + parameters + "}");
}

/// Values of the rows of a group as positions in the ranges: [row][parameter].
std::vector<std::vector<double>> positions(const Expansion& expansion, std::size_t group = 0) {
  const Group& g = expansion.spec.groups.at(group);
  std::vector<std::vector<double>> rows;
  Row row;
  for (long i = 0; i < count_rows(g); ++i) {
    row_at(g, i, row);
    rows.emplace_back();
    for (std::size_t p = 0; p < row.size(); ++p) {
      const Parameter& parameter = g.parameters[p];
      const double from = *parameter.choices.front().si, to = *parameter.choices.back().si;
      rows.back().push_back((*parameter.si(row[p]) - from) / (to - from));
    }
  }
  return rows;
}

/// Values of a parameter in the rows of the first group, SI.
std::vector<double> values_in(const Expansion& expansion, std::size_t parameter) {
  const Group& g = expansion.spec.groups.front();
  std::vector<double> values;
  Row row;
  for (long i = 0; i < count_rows(g); ++i) {
    row_at(g, i, row);
    values.push_back(*g.parameters[parameter].si(row[parameter]));
  }
  return values;
}

std::vector<double> column(const std::vector<std::vector<double>>& rows, std::size_t p) {
  std::vector<double> result;
  for (const auto& row : rows) result.push_back(row[p]);
  return result;
}

/// How many points lie in each n-th part of [0, 1).
std::vector<int> counts(const std::vector<double>& points, std::size_t n) {
  std::vector<int> result(n, 0);
  for (const double x : points) ++result.at(static_cast<std::size_t>(x * static_cast<double>(n)));
  return result;
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    mx += x[i] / n;
    my += y[i] / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    yy += (y[i] - my) * (y[i] - my);
    xy += (x[i] - mx) * (y[i] - my);
  }
  return xy / std::sqrt(xx * yy);
}

TEST(UnitSamples, LatinHypercubeHasOnePointInEveryPart) {
  for (const std::size_t n : {1U, 7U, 1000U}) {
    const UnitSamples samples = latin_hypercube(n, 3, 1);
    for (const auto& one : samples) EXPECT_EQ(counts(one, n), std::vector<int>(n, 1));
  }
  const UnitSamples samples = latin_hypercube(10000, 2, 1);
  EXPECT_LT(std::abs(correlation(samples[0], samples[1])), 0.04) << "four standard deviations";
  std::vector<double> within = samples[0];
  for (double& x : within) x = x * 10000 - std::floor(x * 10000);
  for (const int n : counts(within, 10)) EXPECT_NEAR(n, 1000, 120) << "uniform within parts too";
}

TEST(UnitSamples, SobolSequenceIsADigitalNet) {
  const UnitSamples samples = sobol_sequence(256, 12, 1);
  for (const auto& one : samples) EXPECT_EQ(counts(one, 256), std::vector<int>(256, 1));
  // Dimensions 0 and 1 are a (0, 8, 2)-net: one point in each box of 2^-k x 2^-(8-k).
  for (const double k : {4.0, 16.0, 64.0}) {
    std::set<std::pair<double, double>> boxes;
    for (std::size_t i = 0; i < 256; ++i) {
      boxes.emplace(std::floor(samples[0][i] * k), std::floor(samples[1][i] * 256 / k));
    }
    EXPECT_EQ(boxes.size(), 256u) << k;
  }
  for (const double x : {samples[0][0], samples[5][3]}) EXPECT_TRUE(x >= 0 && x < 1);
}

TEST(SampledDesigns, LatinHypercubeHasOneSampleInEveryPartOfARange) {
  const auto all = expand_kind(R"("latin-hypercube", "samples": 50)");
  ASSERT_EQ(all.cases.size(), 50u);
  EXPECT_EQ(all.families.size(), 1u);
  const auto rows = positions(all);
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_EQ(counts(column(rows, p), 50), std::vector<int>(50, 1)) << p;
  }
  expect_true_identities(all, 1);
}

TEST(SampledDesigns, AValueIsExactlyWhatTheSceneGets) {
  const auto all = expand_kind(R"("latin-hypercube", "samples": 20)");
  for (const Case& one : all.cases) {
    const auto values = parameters_of(all, one);
    EXPECT_NE(values[0].text.find(" deg"), std::string::npos);
    EXPECT_NE(values[1].text.find(" bar"), std::string::npos) << "the unit of from";
    EXPECT_EQ(scene_of(all, one)["friction"]["friction_angle"], values[0].text);
    EXPECT_EQ(*values[0].si, faultsim::parse_quantity(values[0].text, values[0].dimension).value);
    EXPECT_EQ(*values[1].si, faultsim::parse_quantity(values[1].text, values[1].dimension).value);
    EXPECT_EQ(std::stod(values[2].text), *values[2].si);
  }
}

TEST(SampledDesigns, LogRangesAreUniformInTheLogarithm) {
  const auto all =
      expand_kind(R"("latin-hypercube", "samples": 30)",
                  R"("parameters": {"caprock_viscosity": {"from": "1e17 Pa s", "to": "1e20 Pa s",
                                              "spacing": "log"}})");
  std::vector<double> logs;
  for (const Case& one : all.cases) {
    logs.push_back((std::log10(*parameters_of(all, one)[0].si) - 17) / 3);
  }
  EXPECT_EQ(counts(logs, 30), std::vector<int>(30, 1));
}

TEST(SampledDesigns, ListedValuesAreEquallyLikelyLevels) {
  const auto all = expand_kind(R"("latin-hypercube", "samples": 60)", R"("parameters": {
      "offset": ["0 m", "50 m", "100 m"],
      "stiff": {"scale": "caprock_stiffness", "factors": [1, 2]},
      "p": {"variants": {"mean": {"fault_pressure": "mean"}, "max": {"fault_pressure": "max"}}},
      "friction_angle": {"from": "15 deg", "to": "35 deg"}})");
  ASSERT_EQ(all.cases.size(), 60u);
  EXPECT_EQ(all.families.size(), 6u) << "samples share the operators of the levels";
  std::map<std::string, int> seen;
  for (const Case& one : all.cases) {
    const auto values = parameters_of(all, one);
    for (std::size_t p = 0; p < 3; ++p) ++seen[values[p].name + " " + values[p].text];
  }
  for (const char* offset : {"offset 0 m", "offset 50 m", "offset 100 m"}) {
    EXPECT_EQ(seen[offset], 20) << offset;
  }
  EXPECT_EQ(seen["stiff 1"], 30);
  EXPECT_EQ(seen["p max"], 30);
}

/// Blocks as SALib's sobol.analyze takes them apart: A = Y[0::step], AB_j = Y[1+j::step],
/// BA_j = Y[1+D+j::step], B = Y[step-1::step].
TEST(SampledDesigns, SobolBlocksShareTheColumnsTheyShould) {
  for (const bool second_order : {false, true}) {
    const auto all = expand_kind(std::string(R"("sobol", "samples": 16, "second_order": )") +
                                 (second_order ? "true" : "false"));
    const auto rows = positions(all);
    const std::size_t step = second_order ? 8 : 5;
    ASSERT_EQ(rows.size(), 16 * step);
    for (std::size_t i = 0; i < 16; ++i) {
      const auto& a = rows[i * step];
      const auto& b = rows[i * step + step - 1];
      for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_NE(a[j], b[j]);
        auto ab = a, ba = b;
        ab[j] = b[j];
        ba[j] = a[j];
        EXPECT_EQ(rows[i * step + 1 + j], ab) << i;
        if (second_order) {
          EXPECT_EQ(rows[i * step + 4 + j], ba) << i;
        }
      }
    }
    for (std::size_t p = 0; p < 3; ++p) {
      std::vector<double> a, b;
      for (std::size_t i = 0; i < 16; ++i) {
        a.push_back(rows[i * step][p]);
        b.push_back(rows[i * step + step - 1][p]);
      }
      EXPECT_EQ(counts(a, 16), std::vector<int>(16, 1)) << "balanced";
      EXPECT_EQ(counts(b, 16), std::vector<int>(16, 1)) << "balanced";
    }
  }
}

/// The indices of a function that is known give those of its formula: f = 4 x1 + 2 x2 + x1 x3.
TEST(SampledDesigns, SobolRowsGiveTheIndicesOfAKnownFunction) {
  const auto all = expand_kind(R"("sobol", "samples": 4096)");
  const auto rows = positions(all);
  std::vector<double> y;
  for (const auto& x : rows) y.push_back(4 * x[0] + 2 * x[1] + x[0] * x[2]);
  // Var(x) = 1/12; f = 4.5 u1 + 2 u2 + u3 / 2 + u1 u3 + constant with u = x - 1/2.
  const double v1 = 4.5 * 4.5 / 12, v2 = 4.0 / 12, v3 = 0.25 / 12, v13 = 1.0 / 144;
  const double v = v1 + v2 + v3 + v13;
  const double first[] = {v1 / v, v2 / v, v3 / v};
  const double total[] = {(v1 + v13) / v, v2 / v, (v3 + v13) / v};
  for (std::size_t j = 0; j < 3; ++j) {
    double s = 0, t = 0;  // Saltelli et al. (2010), table 2, (b) and (f)
    for (std::size_t i = 0; i < 4096; ++i) {
      const double a = y[5 * i], ab = y[5 * i + 1 + j], b = y[5 * i + 4];
      s += b * (ab - a) / 4096;
      t += (a - ab) * (a - ab) / 2 / 4096;
    }
    EXPECT_NEAR(s / v, first[j], 0.01) << j;
    EXPECT_NEAR(t / v, total[j], 0.005) << j;
  }
}

/// Two levels are told apart by the first binary digit alone. In the first 16 points it agrees in
/// two of the pairs of dimensions (j, j + 5) of the sequence, so that two of five parameters would
/// have the same level in A and B of every sample.
TEST(SampledDesigns, SobolLevelsOfAAndBArePairedAtRandom) {
  const auto all = expand_kind(R"("sobol", "samples": 16)", R"("parameters": {
      "cohesion": ["0 MPa", "2 MPa"], "ratio_across": [0.5, 0.7], "ratio_along": [0.5, 0.7],
      "friction_angle": ["15 deg", "35 deg"], "offset": ["0 m", "100 m"]})");
  const auto rows = positions(all);
  for (std::size_t p = 0; p < 5; ++p) {
    int equal = 0, high = 0;
    for (std::size_t i = 0; i < 16; ++i) {
      equal += rows[7 * i][p] == rows[7 * i + 6][p] ? 1 : 0;
      high += rows[7 * i][p] == 1 ? 1 : 0;
    }
    EXPECT_EQ(high, 8) << "balanced";
    EXPECT_NEAR(equal, 8, 6) << p;
  }
}

TEST(SampledDesigns, SobolSaysWhenSamplesAreNoPowerOfTwo) {
  const auto odd = expand_kind(R"("sobol", "samples": 12)");
  EXPECT_EQ(odd.notes, std::vector<std::string>{"12 samples of /design are not a power of two: the "
                                                "sequence is balanced only at powers of two"});
  EXPECT_THAT(expand_kind(R"("sobol", "samples": 8)").notes, ElementsAre());
}

TEST(SampledDesigns, MorrisMovesEveryParameterOncePerTrajectoryByDelta) {
  const auto all = expand_kind(R"("morris", "trajectories": 40, "levels": 6)");
  const auto rows = positions(all);
  ASSERT_EQ(rows.size(), 160u);
  std::map<int, int> levels;
  std::set<std::vector<std::size_t>> orders;
  int n_up = 0;
  for (std::size_t t = 0; t < 40; ++t) {
    std::vector<std::size_t> order;
    for (std::size_t i = 4 * t; i < 4 * t + 4; ++i) {
      for (std::size_t p = 0; p < 3; ++p) {
        const double level = rows[i][p] * 5;
        EXPECT_NEAR(level, std::round(level), 1e-9);
        ++levels[static_cast<int>(std::lround(level))];
        if (i == 4 * t || rows[i][p] == rows[i - 1][p]) continue;
        EXPECT_NEAR(std::abs(rows[i][p] - rows[i - 1][p]), 6 / (2 * 5.0), 1e-12);
        n_up += rows[i][p] > rows[i - 1][p] ? 1 : 0;
        order.push_back(p);
      }
    }
    EXPECT_EQ(order.size(), 3u) << "one per row";
    orders.insert(order);
    EXPECT_EQ(std::set<std::size_t>(order.begin(), order.end()).size(), 3u) << "each once";
  }
  EXPECT_EQ(orders.size(), 6u) << "all orders occur";
  EXPECT_EQ(levels.size(), 6u) << "all levels occur";
  EXPECT_NEAR(n_up, 60, 22) << "up as often as down";
}

TEST(SampledDesigns, MorrisListsMoveToo) {
  const auto all = expand_kind(R"("morris", "trajectories": 20, "levels": 6)", R"("parameters": {
      "offset": ["0 m", "50 m", "100 m"],
      "p": {"variants": {"mean": {"fault_pressure": "mean"}, "max": {"fault_pressure": "max"}}}})");
  const Group& group = all.spec.groups[0];
  Row before, row;
  for (long i = 0; i < count_rows(group); ++i) {
    row_at(group, i, row);
    if (i % 3 != 0) {
      EXPECT_EQ((row[0] != before[0]) + (row[1] != before[1]), 1) << i;
    }
    before = row;
  }
  // Six cases there are; 60 rows meet in them and are found again.
  EXPECT_LE(all.cases.size(), 6u);
  EXPECT_EQ(all.n_merged, 60 - static_cast<long>(all.cases.size()));
  ASSERT_EQ(all.case_of_row[0].size(), 60u);
  for (long i = 0; i < 60; ++i) {
    row_at(group, i, row);
    const auto place = static_cast<std::size_t>(all.case_of_row[0][static_cast<std::size_t>(i)]);
    EXPECT_EQ(all.cases.at(place).choices, row);
  }
}

TEST(SampledDesigns, TheSeedDecides) {
  for (const char* kind : {R"("latin-hypercube", "samples": 16)", R"("sobol", "samples": 16)",
                           R"("morris", "trajectories": 16)"}) {
    const auto rows = positions(expand_kind(kind));
    EXPECT_EQ(rows, positions(expand_kind(kind))) << kind;
    EXPECT_EQ(rows, positions(expand_kind(std::string(kind) + R"(, "seed": 1)"))) << kind;
    EXPECT_NE(rows, positions(expand_kind(std::string(kind) + R"(, "seed": 2)"))) << kind;
    const auto beside = expand_design(
        R"({"kind": "groups", "groups": [
             {"name": "a", "design": {"kind": "latin-hypercube", "samples": 3, "seed": 7, )" +
        std::string(kThree) + R"(}}, {"name": "b", "design": {"kind": )" + kind + ", " + kThree +
        "}}]}");
    EXPECT_EQ(rows, positions(beside, 1)) << "whatever stands beside it";
  }
}

/// The numbers themselves, so that no library, compiler or later version changes a stored design
/// unseen. The first output of std::mt19937_64 with its default seed is in the C++ standard; these
/// are what this code made of it when the properties above were checked.
TEST(SampledDesigns, StayTheSameForEver) {
  const auto texts = [](const char* kind) {
    const auto all = expand_kind(kind);
    std::string text;
    for (const auto& value : parameters_of(all, all.cases[1])) text += value.text + " ";
    return text;
  };
  EXPECT_EQ(texts(R"("latin-hypercube", "samples": 4)"),
            "26.7544905689146 deg 6.4227442664432 bar 0.684324225710695 ");
  EXPECT_EQ(texts(R"("sobol", "samples": 4)"),
            "15.4204845683345 deg 6.31987441828169 bar 0.725607451922269 ");
  EXPECT_EQ(texts(R"("morris", "trajectories": 4)"), "15 deg 1 bar 0.833333333333333 ");
}

TEST(SampledDesigns, NestedHasEveryInnerRowInEveryOuterOne) {
  const auto all = expand_design(R"({"kind": "nested", "designs": [
      {"kind": "list", "cases": [{"offset": "0 m"}, {"offset": "100 m", "biot": 0.8}]},
      {"kind": "grid", "parameters": {"fault_pressure": ["mean", "max"]}},
      {"kind": "latin-hypercube", "samples": 5, "parameters": {
         "friction_angle": {"from": "15 deg", "to": "35 deg"},
         "cohesion": {"from": "0 MPa", "to": "4 MPa"}}}]})");
  ASSERT_EQ(all.cases.size(), 20u);
  EXPECT_EQ(all.families.size(), 2u);
  const auto texts = [&](std::size_t i) {
    std::vector<std::string> result;
    for (const auto& value : parameters_of(all, all.cases[i])) result.push_back(value.text);
    return result;
  };
  std::set<std::string> samples;
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(texts(i)[0], i < 10 ? "0 m" : "100 m");
    EXPECT_EQ(texts(i)[1], i < 10 ? "1" : "0.8");
    EXPECT_EQ(texts(i)[2], i / 5 % 2 == 0 ? "mean" : "max");
    EXPECT_EQ(texts(i)[3], texts(i % 5)[3]) << "the same sample in each outer row";
    samples.insert(texts(i)[3]);
  }
  EXPECT_EQ(samples.size(), 5u);
  expect_true_identities(all, 1);
}

TEST(SampledDesigns, LatinHypercubeLeavesOutWhatIsExcluded) {
  const auto all = expand_design(
      R"({"kind": "latin-hypercube", "samples": 40, )" + std::string(kThree) + "}",
      R"("exclude": ["friction_angle < 20 deg"], "derived": {"ratio_along": "biot / 2"}, )");
  EXPECT_EQ(all.excluded[0].n_cases, 10) << "a quarter of the range";
  EXPECT_EQ(all.cases.size(), 30u);
  EXPECT_EQ(std::count(all.case_of_row[0].begin(), all.case_of_row[0].end(), -1), 10);
  for (const Case& one : all.cases) EXPECT_GE(*parameters_of(all, one)[0].si, 20 * M_PI / 180);
  expect_true_identities(all, 1);
}

TEST(SampledDesigns, ADrawnParameterOfTheOperatorIsPointedOut) {
  const auto all = expand_kind(R"("latin-hypercube", "samples": 3)",
                               R"("parameters": {"offset": {"from": "0 m", "to": "100 m"}})");
  EXPECT_EQ(all.families.size(), 3u);
  EXPECT_EQ(all.notes,
            std::vector<std::string>{
                "\"offset\" of /design is drawn from a range and changes the operator: each of its "
                "values is a family of its own; values of a short list would share operators"});
}

TEST(SampledDesigns, TheResolvedSpecSaysHowTheSampleIsMade) {
  const auto all = expand_kind(R"("sobol", "samples": 8)");
  const auto resolved = nlohmann::json::parse(all.spec.resolved());
  const auto& group = resolved["groups"][0];
  EXPECT_EQ(group["kind"], "sobol");
  EXPECT_EQ(group["samples"], 8);
  EXPECT_EQ(group["seed"], 1) << "the default is written out";
  EXPECT_EQ(group["second_order"], false);
  const auto& cohesion = group["parameters"][1];
  EXPECT_EQ(cohesion["range"]["from"], "1 bar");
  EXPECT_EQ(cohesion["range"]["to_si"], 4e6);
  EXPECT_FALSE(cohesion.contains("choices"));
}

TEST(SampledDesigns, HundredThousandSamplesExpandInSeconds) {
  const faultsim::Stopwatch watch;
  const auto all = expand_kind(R"("latin-hypercube", "samples": 100000)", R"("parameters": {
      "friction_angle": {"from": "15 deg", "to": "35 deg"},
      "cohesion": {"from": "0 MPa", "to": "4 MPa"},
      "overpressure": {"from": "25 bar", "to": "40 bar"},
      "ratio_across": {"from": 0.5, "to": 0.9}})");
  const double seconds = watch.seconds();
  RecordProperty("seconds", std::to_string(seconds));
  EXPECT_EQ(all.cases.size(), 100000u);
  EXPECT_EQ(all.families.size(), 1u);
  // Alone on a machine it is about 2 s; here, under the sanitizers and beside other tests too, only
  // a guard against reading every scene.
  EXPECT_LT(seconds, 100.0);
  expect_true_identities(all, 9973);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TEST(Distributions, AreThoseOfTheSpecInSi) {
  const Expansion all = expand_kind(R"("latin-hypercube", "samples": 500)", R"("parameters": {
      "friction_angle": {"distribution": "normal", "mean": "25 deg", "deviation": "3 deg"},
      "cohesion": {"distribution": "triangular", "from": "0 MPa", "mode": "10 bar", "to": "5 MPa"},
      "biot": {"distribution": "normal", "mean": 0.9, "deviation": 0.1, "to": 1, "from": 0.5}})");
  ASSERT_EQ(all.cases.size(), 500u);
  constexpr double kDegree = 0.017453292519943295;
  EXPECT_NEAR(mean_of(values_in(all, 0)) / kDegree, 25, 0.05);
  EXPECT_NEAR(mean_of(values_in(all, 1)), 2e6, 0.01e6);  // (0 + 1 + 5) / 3 MPa
  const std::vector<double> biot = values_in(all, 2);
  EXPECT_LE(*std::max_element(biot.begin(), biot.end()), 1);
  EXPECT_NEAR(mean_of(biot), 0.9 - 0.1 * 0.28761, 2e-3);  // φ(1) / Φ(1) deviations below
  expect_true_identities(all, 97);
}

TEST(Distributions, KeepTheFirstSamplesOfALongerSample) {
  const std::string parameters = R"("parameters": {
      "friction_angle": {"distribution": "normal", "mean": "25 deg", "deviation": "2 deg"},
      "cohesion": {"from": "0 MPa", "to": "2 MPa"}},
      "correlations": [{"of": ["friction_angle", "cohesion"], "rank": -0.6}])";
  const Expansion few = expand_kind(R"("monte-carlo", "samples": 40)", parameters);
  const Expansion many = expand_kind(R"("monte-carlo", "samples": 60)", parameters);
  for (std::size_t k = 0; k < few.cases.size(); ++k)
    EXPECT_EQ(few.cases[k].identity, many.cases[k].identity);
}

TEST(Correlations, AreThoseOfTheSpec) {
  const Expansion all = expand_kind(R"("latin-hypercube", "samples": 4000)", R"("parameters": {
      "friction_angle": {"from": "15 deg", "to": "35 deg"}, "biot": {"from": 0.5, "to": 1},
      "cohesion": {"from": "0 MPa", "to": "2 MPa"}},
      "correlations": [{"of": ["cohesion", "friction_angle"], "rank": -0.6}])");
  const auto rows = positions(all);
  EXPECT_NEAR(correlation(column(rows, 0), column(rows, 2)), -0.6, 0.03);
  EXPECT_NEAR(correlation(column(rows, 0), column(rows, 1)), 0, 0.05);
}

/// One problem each: what of the parameters, and where.
TEST(Distributions, SayWhatIsWrongWithThem) {
  const auto problem_of = [](const std::string& kind, const std::string& biot) {
    try {
      expand_kind(kind, R"("parameters": {"friction_angle": {"from": "15 deg", "to": "35 deg"},
                          "biot": )" +
                            biot);
    } catch (const faultsim::InputError& error) {
      std::string text;
      for (const auto& one : error.problems()) text += one.pointer + ": " + one.what + "; ";
      return text;
    }
    return std::string("nothing");
  };
  const std::string sample = R"("monte-carlo", "samples": 50)";
  const std::string normal = R"({"distribution": "normal", "mean": 0.8, )";
  for (const auto& [kind, biot, said] : std::vector<std::array<std::string, 3>>{
           {sample, normal + R"("median": 1}})", "a normal needs deviation"},
           {sample, normal + R"("median": 1}})", "a normal has no median"},
           {sample, normal + R"("deviation": 0}})", "the deviation is not above zero"},
           {sample, normal + R"("deviation": 0.1, "from": 1, "to": 0.5}})",
            "a value not above from"},
           {sample, normal + R"("deviation": 0.001, "from": 0.9, "to": 1}})", "no part of it lies"},
           {sample, normal + R"("deviation": 0.1, "count": 3}})", "a normal has no count"},
           {R"("grid")", normal + R"("deviation": 0.1}})", "nothing is drawn in a grid"},
           {R"("morris", "trajectories": 4)", normal + R"("deviation": 0.1}})", "both ends"},
           {sample, R"({"distribution": "log-normal", "median": 0.8, "factor": 1}})",
            "not above 1"},
           {sample, R"({"distribution": "normal", "mean": 1, "deviation": 1e308}})", "too large"},
           {sample, R"({"distribution": "log-normal", "median": 1, "factor": 1e300}})",
            "too large"},
           {sample, R"({"distribution": "triangular", "from": 0.5, "mode": 2, "to": 1}})",
            "the mode is not between"},
           {sample, R"({"from": 0.5, "to": 1, "mean": 0.8}})", "mean needs distribution"},
           {sample,
            R"({"distribution": "normal", "mean": "0.8 m", "deviation": 0.1, "from": 0.5}})",
            "biot/mean: \"0.8 m\" has a unit"},
           {sample, R"({"distribution": "normal", "mean": 0.8, "deviation": "1 m", "to": 1}})",
            "biot/deviation: \"1 m\" has a unit"},
           {sample, R"([0.5, 1]}, "correlations": [{"of": ["biot", "friction_angle"], "rank": 0}])",
            "has listed values"},
           {sample, R"([0.5, 1]}, "correlations": [{"of": ["boit", "friction_angle"], "rank": 0}])",
            "no parameter"}}) {
    EXPECT_THAT(problem_of(kind, biot), ::testing::HasSubstr(said)) << biot;
  }
  // Without ends its tails leave what the scene accepts, which is found before anything starts.
  EXPECT_THAT(problem_of(sample, normal + R"("deviation": 0.1}})"),
              ::testing::HasSubstr("/design/parameters/biot/distribution"));
}

}  // namespace
}  // namespace faultsweep
