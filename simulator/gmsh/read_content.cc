#include "simulator/gmsh/read_content.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "simulator/common/printable.h"
#include "simulator/common/ranges.h"
#include "simulator/common/table_reader.h"
#include "simulator/gmsh/read_elements.h"
#include "simulator/gmsh/read_nodes.h"

namespace faultsim {
namespace {

constexpr const char* kNameCure =
    "write the dimension and the number of the group, from 1, and its name in quotes: "
    "3 1 \"reservoir\"";

/// $PhysicalNames: lines in all files.
void read_names(TextRecords& lines, FileProblems& problems, GmshContent& content) {
  if (!lines.next("the number of names")) return;
  const int head = lines.place();
  const std::int64_t n_names = lines.count();
  const bool has_head = lines.is_whole();
  std::int64_t n_lines = 0;
  for (; lines.next("the dimension, number and name of a physical group"); ++n_lines) {
    const std::int64_t dimension = lines.integer(), number = lines.integer();
    const std::string_view quoted = lines.rest_of_line();
    if (!lines.is_sound()) continue;
    const auto refuse = [&](const std::string& what) {
      problems.add(lines.place(), kNameCure, [&] { return table_quote(lines.line()) + what; });
    };
    const bool has_quotes = quoted.size() >= 2 && quoted.front() == '"' && quoted.back() == '"';
    if (!has_quotes || dimension < 0 || dimension > 3 || number < 1) {
      refuse(" is not the name of a physical group");
      continue;
    }
    const std::string name(quoted.substr(1, quoted.size() - 2));
    if (const std::string odd = first_unprintable(name); !odd.empty()) {
      refuse(" contains \"" + odd + "\", which is not a text character");
      continue;
    }
    if (name.empty()) continue;  // the group is called by its number
    auto& names = content.names[static_cast<std::size_t>(dimension)];
    if (!names.emplace(number, PhysicalName{name, lines.place()}).second)
      refuse(concat(" names a group that already has a name, at ",
                    problems.name_of(names[number].place)));
  }
  if (!has_head || n_lines == n_names) return;
  problems.add(head, kSaveAnew, [&] {
    return concat("$PhysicalNames says ", counted(n_names, "name", "names"), " but has ", n_lines);
  });
}

/// $Entities, of which only physical groups matter.
class EntityReader {
 public:
  EntityReader(Records& records, FileProblems& problems, GmshContent& content)
      : records_(records), problems_(problems), content_(content) {}

  /// Whether all of it could be read.
  bool read() {
    if (!records_.next("the numbers of points, curves, surfaces and volumes")) return true;
    std::array<std::int64_t, 4> wanted{};
    for (std::int64_t& n : wanted) n = records_.count();
    const int head = records_.place();
    if (!records_.is_whole()) return false;
    for (std::size_t dimension = 0; dimension < wanted.size(); ++dimension) {
      std::int64_t n = 0;
      while (n < wanted[dimension] && records_.next(kForms[dimension])) {
        ++n;
        entity(dimension);
        is_whole_ = records_.is_whole() && is_whole_;
        if (!is_whole_ && problems_.is_binary())
          return false;  // where the next begins is not known
      }
      if (n == wanted[dimension]) continue;
      problems_.add(head, kSaveAnew, [&] {
        return concat("$Entities says ",
                      counted(wanted[dimension], kOne[dimension], kMany[dimension]), " but has ",
                      n);
      });
      return false;
    }
    if (!records_.next("nothing")) return is_whole_;
    problems_.add(records_.place(), kSaveAnew,
                  [] { return "$Entities continues after its last volume"; });
    return false;
  }

 private:
  static constexpr std::array<const char*, 4> kOne{"point", "curve", "surface", "volume"};
  static constexpr std::array<const char*, 4> kMany{"points", "curves", "surfaces", "volumes"};
  static constexpr std::array<const char*, 4> kForms{
      "the number of a point, x, y, z, count and numbers of its physical groups",
      "the number of a curve, its box, counts and numbers of its physical groups and points",
      "the number of a surface, its box, counts and numbers of its physical groups and curves",
      "the number of a volume, its box, counts and numbers of its physical groups and surfaces"};

  void entity(std::size_t dimension) {
    GmshEntity one;
    one.place = records_.place();
    const std::int64_t number = records_.integer();
    records_.skip(dimension == 0 ? 3 : 6);
    for (std::int64_t n = records_.count(); n > 0 && records_.is_sound(); --n)
      one.physical.push_back(records_.integer());
    if (dimension > 0) {
      for (std::int64_t n = records_.count(); n > 0 && records_.is_sound(); --n) records_.integer();
    }
    if (!records_.is_sound() || dimension < 2) return;
    const std::string name = concat(kOne[dimension], ' ', number);
    // Minus: elements are turned over. Twice in one group is once.
    for (std::int64_t& group : one.physical) group = std::abs(group);
    std::ranges::sort(one.physical);
    drop_repeated(one.physical);
    if (contains(one.physical, 0)) {
      problems_.add(one.place, "number physical groups from 1",
                    [&] { return concat(name, " belongs to a physical group 0"); });
    }
    const auto known = content_.entities[dimension].emplace(number, one);
    if (known.second) return;
    problems_.add(one.place, kSaveAnew, [&] {
      const int first = known.first->second.place;
      return concat(name, " is given twice, first at ", problems_.name_of(first));
    });
  }

  Records& records_;
  FileProblems& problems_;
  GmshContent& content_;
  bool is_whole_ = true;
};

class ContentReader {
 public:
  ContentReader(const FileForm& form, FileProblems& problems) : form_(form), problems_(problems) {}

  GmshContent read(std::string_view text) {
    const FileSections sections = split_sections(text, problems_);
    std::vector<std::string_view> read;
    for (const FileSection& one : sections.found) {
      if (contains(read, one.name)) {
        refuse_second(one);
      } else {
        section(one);
        read.push_back(one.name);
      }
    }
    if (contains(read, "PartitionedEntities")) content_.has_all_entities = false;
    for (const std::string_view name : {"Entities", "Nodes", "Elements"}) {
      if (sections.is_cut || contains(read, name)) continue;
      problems_.add(0, "save the mesh as Gmsh does, with $Entities, $Nodes and $Elements",
                    [&] { return concat("there is no section $", name); });
    }
    return std::move(content_);
  }

 private:
  void refuse_second(const FileSection& one) {
    problems_.add(one.place, "keep one of the two sections",
                  [&] { return concat("there is a second section $", one.name); });
    if (one.name == "Entities") content_.has_all_entities = false;
    if (one.name == "Nodes") content_.has_all_nodes = false;
    if (one.name == "Elements") content_.has_all_elements = false;
  }

  void section(const FileSection& one) {
    if (one.name == "PartitionedEntities") {
      problems_.add(one.place, "save it in one part: UnpartitionMesh in Gmsh's script, no -part",
                    [] { return "the mesh is partitioned"; });
    } else if (one.name == "PhysicalNames") {
      TextRecords lines(one.body, problems_);
      read_names(lines, problems_, content_);
    } else if (one.name != "MeshFormat") {
      numbers(one, *records_of(one));
    }
  }

  void numbers(const FileSection& one, Records& records) {
    if (one.name == "Entities") {
      content_.has_all_entities = EntityReader(records, problems_, content_).read();
    } else if (one.name == "Nodes") {
      content_.has_all_nodes = read_nodes(records, problems_, content_);
    } else {
      content_.has_all_elements = read_elements(records, problems_, content_);
    }
  }

  std::unique_ptr<Records> records_of(const FileSection& one) const {
    if (!form_.is_binary) return std::make_unique<TextRecords>(one.body, problems_);
    FilePart bytes = one.body;  // the end of the line before $End is not of the numbers
    if (!bytes.bytes.empty() && bytes.bytes.back() == '\n') bytes.bytes.remove_suffix(1);
    return std::make_unique<BinaryRecords>(bytes, form_.is_swapped, problems_);
  }

  const FileForm& form_;
  FileProblems& problems_;
  GmshContent content_;
};

}  // namespace

GmshContent read_content(std::string_view text, const FileForm& form, FileProblems& problems) {
  return ContentReader(form, problems).read(text);
}

}  // namespace faultsim
