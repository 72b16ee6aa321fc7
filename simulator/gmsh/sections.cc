#include "simulator/gmsh/sections.h"

#include <algorithm>
#include <array>
#include <string>

#include "simulator/common/printable.h"
#include "simulator/common/ranges.h"
#include "simulator/common/table_reader.h"

namespace faultsim {
namespace {

constexpr std::array<std::string_view, 6> kKnownSections{
    "MeshFormat", "PhysicalNames", "Entities", "PartitionedEntities", "Nodes", "Elements"};
constexpr const char* kEndCure = "end each section $X with a line $EndX; the file may be cut off";

std::string_view without_space_behind(std::string_view line) {
  while (!line.empty() && (line.back() == ' ' || line.back() == '\t' || line.back() == '\r'))
    line.remove_suffix(1);
  return line;
}

/// The first line of a text.
std::string_view first_line(std::string_view text) {
  return without_space_behind(text.substr(0, text.find('\n')));
}

std::string first_word(std::string_view line) {
  constexpr std::size_t kMostLetters = 20;
  return shortened(line.substr(0, line.find_first_of(" \t")), kMostLetters);
}

/// What follows one of the lines of a text.
std::string_view behind_line(std::string_view text, std::string_view line) {
  text.remove_prefix(static_cast<std::size_t>(line.data() - text.data()) + line.size());
  text.remove_prefix(std::min(text.find('\n'), text.size()));
  return text.substr(text.empty() ? 0 : 1);
}

class SectionSplitter {
 public:
  SectionSplitter(std::string_view text, FileProblems& problems)
      : text_(text), problems_(problems) {}

  FileSections split() {
    while (at_ < text_.size() && n_unended_ < kMostUnended) {
      const std::string_view line = first_line(text_.substr(at_));
      if (line.empty()) {
        go_on_behind_line();
      } else if (line.front() != '$' || line.substr(0, 4) == "$End") {
        outside(line);
      } else {
        section(line.substr(1));
      }
    }
    return std::move(sections_);
  }

 private:
  /// Of sections that do not end: each may be looked through to the file's end.
  static constexpr int kMostUnended = 20;
  static constexpr std::size_t kNowhere = std::string_view::npos;

  int place() const { return problems_.is_binary() ? static_cast<int>(at_) : line_; }

  void go_on_at(std::size_t to) {
    line_ += static_cast<int>(std::ranges::count(text_.substr(at_, to - at_), '\n'));
    at_ = to;
  }
  void go_on_behind_line() {
    const std::size_t end = text_.find('\n', at_);
    go_on_at(end == kNowhere ? text_.size() : end + 1);
  }
  /// The next line that begins with this, from `from` on or the line before; or nowhere.
  std::size_t line_with(std::string_view begin, std::size_t from) const {
    const std::size_t found = text_.find("\n" + std::string(begin), from - 1);
    return found == kNowhere ? kNowhere : found + 1;
  }

  void outside(std::string_view line) {
    problems_.add(place(), kEndCure, [&] {
      return line.front() == '$' ? table_quote(line) + " ends a section that has not begun"
                                 : table_quote(line) + " is outside all sections";
    });
    const std::size_t next = line_with("$", at_ + 1);
    go_on_at(next == kNowhere ? text_.size() : next);
  }

  void section(std::string_view name) {
    FileSection one{name, place(), {}};
    go_on_behind_line();
    const std::size_t end = end_of(name);
    if (end == kNowhere) ++n_unended_;
    const std::size_t stop = end == kNowhere ? begin_of_another(name) : end;
    if (end == kNowhere) unended(one, stop);
    one.body = {text_.substr(at_, stop - at_), static_cast<int>(at_), line_};
    if (contains(kKnownSections, name)) sections_.found.push_back(one);
    go_on_at(stop);
    if (end != kNowhere) go_on_behind_line();
  }

  /// Where the line $EndNAME begins; nowhere if there is none, or, in text, another section begins
  /// before it.
  std::size_t end_of(std::string_view name) const {
    const bool is_lines = !problems_.is_binary() || name == "PhysicalNames";
    const std::string wanted = "$End" + std::string(name);
    const bool any_mark = is_lines && contains(kKnownSections, name);
    if (!any_mark) return whole_line(wanted);
    const std::size_t mark = line_with("$", at_);
    return mark != kNowhere && first_line(text_.substr(mark)) == wanted ? mark : kNowhere;
  }
  /// The next line that is this; or nowhere.
  std::size_t whole_line(const std::string& wanted) const {
    std::size_t found = line_with(wanted, at_);
    while (found != kNowhere && first_line(text_.substr(found)) != wanted)
      found = line_with(wanted, found + 1);
    return found;
  }

  std::size_t begin_of_another(std::string_view name) const {
    if (!problems_.is_binary() && contains(kKnownSections, name))
      return std::min(line_with("$", at_), text_.size());
    std::size_t first = text_.size();
    for (const std::string_view known : kKnownSections)
      first = std::min(first, whole_line("$" + std::string(known)));
    return first;
  }

  void unended(const FileSection& one, std::size_t stop) {
    sections_.is_cut = stop == text_.size() || n_unended_ == kMostUnended;
    problems_.add(one.place, kEndCure, [&] {
      const std::string name = table_quote("$" + std::string(one.name));
      if (stop == text_.size()) return "the file ends within the section " + name;
      return concat("the section ", name, " does not end before ",
                    table_quote(first_line(text_.substr(stop))));
    });
    if (n_unended_ == kMostUnended) {
      problems_.add(one.place, kSaveAnew,
                    [&] { return concat(kMostUnended, " sections do not end; no more is read"); });
    }
  }

  std::string_view text_;
  FileProblems& problems_;
  std::size_t at_ = 0;  // the begin of a line
  int line_ = 1;
  int n_unended_ = 0;
  FileSections sections_;
};

[[noreturn]] void refuse_form(const std::string& source, int line, const std::string& what,
                              const std::string& cure) {
  throw InputError(source, {{"", line, what, cure}});
}

/// By the 1 that stands behind the first line.
bool is_swapped(std::string_view body, const std::string& source) {
  if (body.substr(0, 4) == std::string_view("\1\0\0\0", 4)) return false;
  if (body.substr(0, 4) == std::string_view("\0\0\0\1", 4)) return true;
  refuse_form(source, 0, "the number 1, which shows the order of bytes, is missing", kSaveAnew);
}

}  // namespace

FileForm read_file_form(std::string_view text, const std::string& source) {
  const std::string_view first = first_line(text);
  if (text.empty()) refuse_form(source, 0, "the file is empty", kSaveAsMsh41);
  if (first != "$MeshFormat") {
    refuse_form(source, 1,
                "the file begins with " + table_quote(first) + " and not with $MeshFormat",
                kSaveAsMsh41);
  }
  text = behind_line(text, first);
  FileProblems problems(source);
  TextRecords words({text, 0, 2}, problems);
  if (!words.next("version, 0 or 1 for text or binary, size of numbers"))
    refuse_form(source, 1, "the file ends within $MeshFormat", kSaveAnew);
  const double version = words.real();
  constexpr double kVersion = 4.1;
  if (words.is_sound() && version != kVersion) {
    refuse_form(source, words.place(),
                concat("the format is MSH ", first_word(words.line()), ", not 4.1"), kSaveAsMsh41);
  }
  const std::int64_t type = words.integer(), size = words.integer();
  words.is_whole();
  problems.require_none();
  if (type != 0 && type != 1) {
    refuse_form(source, words.place(), concat(type, " is neither 0 (text) nor 1 (binary)"),
                kSaveAnew);
  }
  if (size != 8) {
    refuse_form(source, words.place(),
                concat("numbers of ", size, " bytes are not read, those of 8 are"),
                "save the mesh with Gmsh on a 64-bit computer");
  }
  if (type == 0) return {};
  return {true, is_swapped(behind_line(text, words.line()), source)};
}

FileSections split_sections(std::string_view text, FileProblems& problems) {
  return SectionSplitter(text, problems).split();
}

}  // namespace faultsim
