#pragma once

#include <string_view>
#include <vector>

#include "simulator/gmsh/records.h"

namespace faultsim {

/// How the numbers of a file are written.
struct FileForm {
  bool is_binary = false;
  bool is_swapped = false;  ///< most significant byte first.
};

/// Reads the section $MeshFormat, with which a file begins. Throws InputError where the rest cannot
/// be read: no such section, another format than MSH 4.1.
/// @param source  of the error.
FileForm read_file_form(std::string_view text, const std::string& source);

/// A section of the file: $NAME, its body, $EndNAME.
struct FileSection {
  std::string_view name;
  int place = 0;  ///< of $NAME.
  FilePart body;  ///< what stands between the two lines.
};

struct FileSections {
  std::vector<FileSection> found;
  bool is_cut = false;  ///< the file ends within the last, or is not read to its end.
};

/// Splits a file into its sections, and leaves out those that are not read here (views of results,
/// comments). What stands outside of them, and sections that do not end, are told.
/// @param problems  knows whether the file is binary.
FileSections split_sections(std::string_view text, FileProblems& problems);

}  // namespace faultsim
