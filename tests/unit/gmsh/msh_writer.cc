#include "tests/unit/gmsh/msh_writer.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace faultsim::msh {
namespace {

/// What one puts numbers into, either as text or as bytes.
class Sheet {
 public:
  Sheet(bool is_binary, bool is_big, std::string end)
      : is_binary_(is_binary), is_big_(is_big), end_(std::move(end)) {}

  void line(const std::string& words) { all_ += words + end_; }
  Sheet& integer(int value) { return number(value, std::to_string(value)); }
  Sheet& size(std::uint64_t value) { return number(value, std::to_string(value)); }
  Sheet& real(double value) {
    char words[40];
    std::snprintf(words, sizeof words, "%.17g", value);
    return number(value, words);
  }
  /// Ends a line of a text.
  void stop() {
    if (!is_binary_) all_ += end_;
  }
  /// Ends the bytes of a section.
  void stop_bytes() {
    if (is_binary_) all_ += end_;
  }
  std::string all() const { return all_; }

 private:
  template <typename Number>
  Sheet& number(Number value, const std::string& words) {
    if (!is_binary_) {
      all_ += words + ' ';
      return *this;
    }
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if (is_big_) std::reverse(bytes, bytes + sizeof value);
    all_.append(bytes, sizeof value);
    return *this;
  }

  bool is_binary_, is_big_;
  std::string end_, all_;
};

void write_entities(const File& file, Sheet& sheet) {
  sheet.line("$Entities");
  const auto number_of = [&](int dimension) {
    return static_cast<std::uint64_t>(
        std::count_if(file.entities.begin(), file.entities.end(),
                      [&](const Entity& entity) { return entity.dimension == dimension; }));
  };
  sheet.size(1).size(number_of(1)).size(number_of(2)).size(number_of(3)).stop();
  sheet.integer(1).real(0).real(0).real(0).size(0).stop();  // a point
  for (const Entity& entity : file.entities) {
    sheet.integer(entity.tag);
    for (const double x : {0.0, 0.0, 0.0, 1.0, 1.0, 1.0}) sheet.real(x);
    sheet.size(entity.physical.size());
    for (const int group : entity.physical) sheet.integer(group);
    sheet.size(2).integer(1).integer(-1).stop();
  }
  sheet.stop_bytes();
  sheet.line("$EndEntities");
}

void write_nodes(const File& file, Sheet& sheet) {
  std::uint64_t n = 0, least = ~std::uint64_t{0}, most = 0;
  for (const NodeBlock& block : file.nodes) {
    n += block.tags.size();
    for (const std::uint64_t tag : block.tags) {
      least = std::min(least, tag);
      most = std::max(most, tag);
    }
  }
  sheet.line("$Nodes");
  sheet.size(file.nodes.size()).size(n).size(least).size(most).stop();
  for (const NodeBlock& block : file.nodes) {
    const bool is_parametric = !block.points.empty() && block.points[0].size() > 3;
    sheet.integer(block.dimension).integer(block.entity).integer(is_parametric ? 1 : 0);
    sheet.size(block.tags.size()).stop();
    for (const std::uint64_t tag : block.tags) sheet.size(tag).stop();
    for (const auto& point : block.points) {
      for (const double x : point) sheet.real(x);
      sheet.stop();
    }
  }
  sheet.stop_bytes();
  sheet.line("$EndNodes");
}

void write_elements(const File& file, Sheet& sheet) {
  std::uint64_t n = 0;
  for (const ElementBlock& block : file.elements) n += block.rows.size();
  sheet.line("$Elements");
  sheet.size(file.elements.size()).size(n).size(1).size(n).stop();
  for (const ElementBlock& block : file.elements) {
    sheet.integer(block.dimension).integer(block.entity).integer(block.type);
    sheet.size(block.rows.size()).stop();
    for (const auto& row : block.rows) {
      for (const std::uint64_t one : row) sheet.size(one);
      sheet.stop();
    }
  }
  sheet.stop_bytes();
  sheet.line("$EndElements");
}

std::string written(const File& file, Sheet sheet, bool is_binary) {
  sheet.line("$MeshFormat");
  sheet.line(is_binary ? "4.1 1 8" : "4.1 0 8");
  if (is_binary) sheet.integer(1);
  sheet.stop_bytes();
  sheet.line("$EndMeshFormat");
  if (!file.names.empty()) {
    sheet.line("$PhysicalNames");
    sheet.line(std::to_string(file.names.size()));
    for (const Name& one : file.names)
      sheet.line(std::to_string(one.dimension) + ' ' + std::to_string(one.number) + " \"" +
                 one.name + '"');
    sheet.line("$EndPhysicalNames");
  }
  write_entities(file, sheet);
  write_nodes(file, sheet);
  write_elements(file, sheet);
  return sheet.all();
}

}  // namespace

std::string text(const File& file, const std::string& end) {
  return written(file, Sheet(false, false, end), false);
}

std::string binary(const File& file, ByteOrder order) {
  return written(file, Sheet(true, order == ByteOrder::big, "\n"), true);
}

File two_tetrahedra() {
  File file;
  file.names = {{2, 4, "fault"}, {3, 3, "east"}, {3, 10, "west"}};
  file.entities = {{1, 1, {}}, {2, 7, {4}}, {3, 1, {10}}, {3, 2, {3}}};
  file.nodes = {{0, 1, {1}, {{0, 0, 0}}},
                {2, 7, {2, 3, 4}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                {3, 2, {5}, {{1, 1, 1}}}};
  file.elements = {
      {2, 7, 2, {{1, 2, 3, 4}}}, {3, 1, 4, {{2, 1, 2, 3, 4}}}, {3, 2, 4, {{3, 2, 3, 4, 5}}}};
  return file;
}

}  // namespace faultsim::msh
