#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "simulator/common/errors.h"

namespace faultsim {

/// What is wrong with one file, text or binary, by place: a line from 1, a byte from the file's
/// begin, or 0 = the whole file. Of problems with the same cure the first 20 are spelled out and
/// the others counted.
class FileProblems {
 public:
  explicit FileProblems(std::string source) : source_(std::move(source)) {}

  /// From now on places are bytes.
  void set_binary() { is_binary_ = true; }
  bool is_binary() const { return is_binary_; }

  /// @param cure  a literal.
  /// @param what  () -> text; called only if it is spelled out: a bad file may have millions.
  template <typename What>
  void add(int place, const char* cure, const What& what) {
    if (is_spelled_out(place, cure)) list_.push_back({place, what(), cure});
  }
  bool is_empty() const { return list_.empty(); }
  /// "line 7", "byte 7".
  std::string name_of(int place) const;
  /// Throws InputError with all problems, by place, if there is one.
  void require_none() const;

 private:
  struct One {
    int place;
    std::string what;
    const char* cure;
  };
  struct OfAKind {
    int n = 0;
    int first_counted = 0;  ///< place of the first that is not spelled out.
  };
  bool is_spelled_out(int place, const char* cure);

  std::string source_;
  bool is_binary_ = false;
  std::vector<One> list_;
  std::map<std::string_view, OfAKind> kinds_;  // by cure
};

// Cures that several parts of the reader have.
inline constexpr const char* kSaveAsMsh41 =
    "save the mesh in the format MSH 4.1: gmsh -format msh41, or Mesh.MshFileVersion = 4.1";
inline constexpr const char* kSaveAnew =
    "save the mesh with Gmsh and copy it again; the file is cut off, damaged or changed by hand";

}  // namespace faultsim
