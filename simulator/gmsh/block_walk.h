#pragma once

#include "simulator/gmsh/records.h"

namespace faultsim {

/// Walks through a section of blocks, $Nodes or $Elements: its first record says how many blocks
/// and things in all there are, the first of each block how many things of it follow.
/// @param section   "$Nodes".
/// @param one       "node".
/// @param many      "nodes".
/// @param block     () -> how many things its head says, from behind records.next(); -1: where the
///                  next block begins is not known.
/// @return  whether all of it was walked through, and numbers agree.
template <typename Block>
bool walk_blocks(Records& records, FileProblems& problems, const char* section, const char* one,
                 const char* many, const Block& block) {
  if (!records.next("the numbers of blocks and in all, the least and the largest tag")) return true;
  const int head = records.place();
  const std::int64_t n_blocks = records.count(), n_things = records.count();
  records.skip(2);
  if (!records.is_whole()) return false;
  std::int64_t blocks = 0, n = 0;
  for (; blocks < n_blocks && !records.is_at_end(); ++blocks) {
    const std::int64_t of_block = block();
    if (of_block < 0) return false;
    n += of_block;
  }
  const bool is_all = blocks == n_blocks && n == n_things;
  if (!is_all) {
    problems.add(head, kSaveAnew, [&] {
      return concat(section, " says ", counted(n_blocks, "block", "blocks"), " with ",
                    counted(n_things, one, many), " in all, but has ", blocks, " with ", n);
    });
  }
  if (!records.next("nothing")) return is_all;
  problems.add(records.place(), kSaveAnew,
               [&] { return concat(section, " continues after its last block"); });
  return false;
}

/// Tells of a block that is shorter than its head says.
inline void add_short_block(FileProblems& problems, int head, std::int64_t n_said,
                            std::int64_t n_there, const char* one, const char* many) {
  problems.add(head, kSaveAnew, [&] {
    return concat("the block says ", counted(n_said, one, many), ", but ", n_there, " follow");
  });
}

/// Tells of a block that the section has no room for.
inline void add_endless_block(FileProblems& problems, int head, std::int64_t n_said,
                              const char* one, const char* many) {
  problems.add(head, kSaveAnew, [&] {
    return concat("the block says ", counted(n_said, one, many),
                  ", more than the section has room for");
  });
}

}  // namespace faultsim
