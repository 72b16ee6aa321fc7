#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <random>
#include <sstream>

#include "tests/fuzz/mutator.h"
#include "tests/unit/gmsh/gmsh_fixture.h"

/// Files of Gmsh, text and binary, that somebody or something has changed: cut off, numbers and
/// lines replaced, swapped and repeated, counts enlarged. Each is read, and then what it says holds
/// together, or refused with problems that have a text, within the time of a blink. Tries files
/// 0, 1, 2, ... up to FAULTSIM_FUZZ_MESHES (default 2000); one that fails is shown.
namespace faultsim {
namespace {

// CPU time, s. Promised are 2; the sanitizers take five times as long.
constexpr double kSlowestMesh = 10;

using Rows = std::vector<std::vector<std::uint64_t>>;

/// A tetrahedron of second order; its nodes have tags that are far apart.
msh::File far_apart() {
  constexpr std::uint64_t kFar = std::uint64_t{1} << 58;
  msh::File file;
  file.names = {{3, 1, "rock"}};
  file.entities = {{2, 1, {1, -2}}, {3, 1, {1}}};
  file.nodes = {{2, 1, {}, {}}, {3, 1, {}, {}}};
  std::vector<std::uint64_t> tetrahedron{7}, triangle{8};
  for (std::uint64_t i = 1; i <= 10; ++i) {
    msh::NodeBlock& block = file.nodes[i < 4 ? 0 : 1];
    block.tags.push_back(i * kFar);
    const double x = static_cast<double>(i);
    block.points.push_back({x, x * x, std::sin(x), x / 2, x / 3});
    if (i >= 4) block.points.back().push_back(x / 4);
    tetrahedron.push_back(i * kFar);
    if (triangle.size() < 7) triangle.push_back(i * kFar);
  }
  file.elements = {{2, 1, 9, Rows{triangle}}, {3, 1, 11, Rows{tetrahedron}}};
  return file;
}

/// A row of hexahedra, with quadrangles, lines and points.
msh::File hexahedra() {
  msh::File file;
  file.entities = {{1, 1, {}}, {2, 1, {1}}, {2, 2, {}}, {3, 1, {1}}, {3, 2, {2}}};
  file.nodes = {{3, 1, {}, {}}};
  Rows cells;
  for (std::uint64_t i = 0; i < 16; ++i) {
    file.nodes[0].tags.push_back(i + 1);
    file.nodes[0].points.push_back({i % 4 == 1 || i % 4 == 2 ? 1.0 : 0.0, i % 4 >= 2 ? 1.0 : 0.0,
                                    std::floor(static_cast<double>(i) / 4)});
    if (i < 3) cells.push_back({i + 10});
    for (std::uint64_t k = 1; k <= 8 && i < 3; ++k) cells.back().push_back(4 * i + k);
  }
  file.elements = {{0, 1, 15, Rows{{1, 1}}},
                   {1, 1, 1, Rows{{2, 1, 2}}},
                   {2, 1, 3, Rows{{3, 5, 6, 7, 8}}},
                   {2, 2, 3, Rows{{4, 1, 2, 3, 4}}},
                   {3, 1, 5, Rows{cells[0], cells[1]}},
                   {3, 2, 5, Rows{cells[2]}}};
  return file;
}

std::vector<std::string> sound_files() {
  std::vector<std::string> files;
  for (const msh::File& file : {msh::two_tetrahedra(), far_apart(), hexahedra()}) {
    files.push_back(msh::text(file));
    files.push_back(msh::binary(file, msh::ByteOrder::little));
    files.push_back(msh::binary(file, msh::ByteOrder::big));
  }
  std::ostringstream of_gmsh;
  of_gmsh << std::ifstream(FAULTSIM_SOURCE_DIR "/tests/cases/gmsh/two_boxes.msh").rdbuf();
  files.push_back(of_gmsh.str());
  return files;
}

/// Changes that know lines and numbers, which the mutator does not.
class MeshChanges {
 public:
  explicit MeshChanges(unsigned long seed) : random_(seed) {}

  std::string changed(std::string bytes) {
    const bool is_text = bytes.find(" 1 8") > 30;
    for (std::size_t n = 1 + below(3); n > 0; --n) {
      if (below(12) == 0) {
        bytes.resize(below(bytes.size() + 1));
      } else if (is_text) {
        change_lines(bytes);
      } else {
        change_numbers(bytes);
      }
    }
    return bytes;
  }

 private:
  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  void change_lines(std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    if (lines.empty()) return;
    std::string& line = lines[below(lines.size())];
    const std::size_t at = below(lines.size());
    const auto place = lines.begin() + static_cast<std::ptrdiff_t>(at);
    switch (below(6)) {
      case 0:
        std::swap(line, lines[at]);
        break;
      case 1:
        lines.erase(place);
        break;
      case 2:
        lines.insert(place, std::string(line));
        break;
      default:
        line = with_another_number(line);
        break;
    }
    text.clear();
    for (const std::string& one : lines) text += one + '\n';
  }

  std::string with_another_number(const std::string& line) {
    static const std::vector<std::string> kNumbers = {"0",
                                                      "-1",
                                                      "1",
                                                      "2",
                                                      "3",
                                                      "4",
                                                      "5",
                                                      "11",
                                                      "1d5",
                                                      "nan",
                                                      "1e400",
                                                      "2147483648",
                                                      "-2147483648",
                                                      "1000000000000000000",
                                                      "9223372036854775807",
                                                      "18446744073709551616",
                                                      "",
                                                      "$Nodes"};
    std::istringstream in(line);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    if (words.empty()) return "7";
    std::string& word = words[below(words.size())];
    const bool longer = below(3) == 0;
    word = longer ? word + "0" : kNumbers[below(kNumbers.size())];
    std::string all;
    for (const std::string& one : words) all += one + ' ';
    return all;
  }

  void change_numbers(std::string& bytes) {
    if (bytes.size() < 8) return;
    const std::size_t at = below(bytes.size() - 7);
    static const std::uint64_t kNumbers[] = {0,
                                             1,
                                             2,
                                             5,
                                             ~std::uint64_t{0},
                                             std::uint64_t{1} << 63,
                                             std::uint64_t{1} << 60,
                                             0x7ff8000000000000,
                                             0x7fffffff,
                                             0x80000000};
    std::string number(8, '\0');
    std::memcpy(number.data(), &kNumbers[below(std::size(kNumbers))], 8);
    if (below(2) == 0) std::reverse(number.begin(), number.end());
    switch (below(4)) {
      case 0:
        bytes.erase(at, 4 * (1 + below(4)));
        break;
      case 1:
        bytes.insert(at, bytes.substr(below(bytes.size()), below(80)));
        break;
      default:
        bytes.replace(at, below(2) == 0 ? 4 : 8, number);
        bytes.resize(std::max<std::size_t>(bytes.size(), 8));
        break;
    }
  }

  std::mt19937_64 random_;
};

void expect_consistent(const GmshMesh& mesh) {
  const auto n_nodes = static_cast<int>(mesh.nodes.size());
  ASSERT_TRUE(mesh.corners_per_cell == 4 || mesh.corners_per_cell == 8);
  ASSERT_EQ(mesh.node_tags.size(), mesh.nodes.size());
  for (const std::int64_t tag : mesh.node_tags) ASSERT_GT(tag, 0);
  for (const Eigen::Vector3d& node : mesh.nodes) ASSERT_TRUE(node.allFinite());
  ASSERT_FALSE(mesh.cell_group.empty());
  ASSERT_EQ(mesh.cells.size(),
            mesh.cell_group.size() * static_cast<std::size_t>(mesh.corners_per_cell));
  std::vector<char> is_used(mesh.nodes.size(), 0);
  for (const int node : mesh.cells) {
    ASSERT_TRUE(node >= 0 && node < n_nodes);
    is_used[static_cast<std::size_t>(node)] = 1;
  }
  ASSERT_EQ(std::count(is_used.begin(), is_used.end(), 0), 0);
  ASSERT_EQ(mesh.facets.size(), mesh.facet_group.size());
  for (const auto& facet : mesh.facets) {
    for (std::size_t k = 0; k < 4; ++k)
      ASSERT_TRUE(facet[k] >= (k == 3 ? -1 : 0) && facet[k] < n_nodes);
  }
  const auto expect_groups = [](std::vector<int> of, const std::vector<std::string>& names) {
    std::sort(of.begin(), of.end());
    of.erase(std::unique(of.begin(), of.end()), of.end());
    ASSERT_EQ(of.size(), names.size());
    for (std::size_t i = 0; i < of.size(); ++i) ASSERT_EQ(of[i], static_cast<int>(i));
    for (const std::string& name : names) ASSERT_FALSE(name.empty());
  };
  expect_groups(mesh.cell_group, mesh.cell_groups);
  expect_groups(mesh.facet_group, mesh.facet_groups);
  ASSERT_GE(mesh.largest_bend, 0);
}

/// Whether a file is read; what must not happen fails.
bool is_read(const std::string& bytes) {
  const GmshFile file(bytes);
  const std::clock_t begin = std::clock();
  bool read = false;
  try {
    expect_consistent(read_gmsh(file.path()));
    read = true;
  } catch (const InputError& error) {
    for (const Problem& one : error.problems())
      EXPECT_TRUE(!one.what.empty() && !one.cure.empty() && one.what.size() < 1000);
    EXPECT_LT(error.problems().size(), 2000U);
  } catch (const std::exception& error) {
    ADD_FAILURE() << error.what();
  }
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, kSlowestMesh);
  return read;
}

TEST(GmshFuzz, ReadsWhatHoldsTogetherAndRefusesTheRest) {
  const char* wanted = std::getenv("FAULTSIM_FUZZ_MESHES");
  const long n_files = wanted == nullptr ? 2000 : std::atol(wanted);
  const std::vector<std::string> corpus = sound_files();
  for (const std::string& bytes : corpus) ASSERT_TRUE(is_read(bytes));
  long n_read = 0;
  for (long seed = 0; seed < n_files && !HasFailure(); ++seed) {
    const auto number = static_cast<unsigned long>(seed);
    const std::string bytes = seed % 4 == 0
                                  ? Mutator(corpus, number).bytes()
                                  : MeshChanges(number).changed(corpus[number / 4 % corpus.size()]);
    n_read += is_read(bytes) ? 1 : 0;
    if (HasFailure()) std::cout << "file " << seed << ":\n" << bytes << '\n';
  }
  std::cout << n_read << " of " << n_files << " changed files are read\n";
  EXPECT_GT(n_read, n_files / 100);
  EXPECT_LT(n_read, n_files / 2);
}

std::string repeated(const std::string& text, std::size_t n_bytes) {
  std::string all;
  while (all.size() < n_bytes) all += text;
  return all;
}

/// Files of some MB, made to take long.
TEST(GmshFuzz, TakesNoLongerForFilesThatAreMadeToTakeLong) {
  constexpr std::size_t kSize = 1'500'000;
  const std::string head = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  const std::string binary_head =
      "$MeshFormat\n4.1 1 8\n" + std::string("\1\0\0\0", 4) + "\n$EndMeshFormat\n$Nodes\n";
  std::string sections, names = "$PhysicalNames\n1\n", tags = "$Nodes\n1 1 1 1\n3 1 0 150000\n";
  for (int i = 0; i < 100'000; ++i) {
    sections += concat("$A", i, "\n$Nodes\n");
    names += concat("3 ", i + 1, " \"same\"\n");
  }
  for (std::uint64_t i = 1; i <= 150'000; ++i) tags += concat(i * 10'000'000'000'000, '\n');
  const std::vector<std::string> files = {
      head + repeated("$A\n", kSize),
      head + sections,
      head + repeated("$Nodes\n$EndNodes\n", kSize),
      head + repeated("$EndA\n", kSize),
      head + repeated("$EndNodes\nx\n", kSize),
      head + names,
      head + tags + repeated("0 0 0\n", kSize),
      head + "$Nodes\n1 200000 1 1\n3 1 0 200000\n" + repeated("1\n", 400'000),
      head + "$Nodes\n" + repeated("1 2 3 4\n", kSize),
      head + "$Elements\n1000000 1 1 1\n" + repeated("3 1 4 0\n", kSize),
      head + "$Elements\n1000000 1 1 1\n" + repeated("3 1 4 1\n1 1 1 1 1\n", kSize),
      head + "$Elements\n1 1000000 1 1\n3 1 4 200000\n" + repeated("x\n", kSize),
      head + "$Entities\n0 0 0 1000000\n" + repeated("1 0 0 0 0 0 0 1 1 0\n", kSize),
      head + "$Entities\n0 0 0 1\n1 0 0 0 0 0 0 1000000 " + repeated("1 ", kSize),
      head + "$Entities\n" + repeated("\n ", kSize),
      head + "$Entities\n" + repeated(" ", kSize) + "1",
      "$MeshFormat\n" + repeated("1", kSize),
      binary_head + repeated(std::string(8, '\1') + "\n$EndNodesX", kSize)};
  for (const std::string& bytes : files) EXPECT_FALSE(is_read(bytes)) << bytes.substr(0, 100);
}

}  // namespace
}  // namespace faultsim
