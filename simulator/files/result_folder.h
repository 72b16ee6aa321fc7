#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace faultsim {

/// What a folder holds, from its contents.json (schemas/contents.schema.json).
struct FolderContents {
  std::string made_by;             ///< "faultsim run".
  std::vector<std::string> files;  ///< entries of the folder, contents.json among them.
  bool holds(const std::string& name) const;
};
/// Nothing where there is no contents.json, or none of ours.
std::optional<FolderContents> contents_of(const std::filesystem::path& folder);

/// A folder that holds one result, whole, or says that it does not.
///
/// All is written into FOLDER/incomplete. commit() takes the files of the result that was there
/// away and puts the new ones in their place; for as long as that lasts, and where there never was
/// a result, FOLDER/INCOMPLETE says so. Files of others in the folder stay. Whenever a process is
/// killed, the folder has the earlier result whole, or the new one, or the file INCOMPLETE, and the
/// next ResultFolder cleans up.
class ResultFolder {
 public:
  struct Request {
    std::string option;                         ///< for messages: "-o".
    std::filesystem::path folder;               ///< made when it is missing, those above are not.
    std::string made_by;                        ///< only results of the same are replaced.
    std::vector<std::string> names;             ///< what may be written into it.
    std::vector<std::filesystem::path> inputs;  ///< files that the command reads.
  };
  /// Throws InputError when the folder may not be written to, holds entries of these names that
  /// are not a result, or a result that is read; StorageError when it cannot be written or another
  /// process writes into it.
  explicit ResultFolder(Request request);
  /// Removes what was written, unless commit() or keep_unfinished() was called.
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  /// Where files are to be written until commit().
  const std::filesystem::path& path() const { return work_; }
  /// Makes all that was written the folder's result. Throws StorageError.
  void commit();
  /// Leaves what was written in path(), which says that it is incomplete.
  void keep_unfinished() { keep_ = true; }

 private:
  void check_entries() const;
  void start();
  void replace(const FolderContents& made);

  Request request_;
  std::filesystem::path folder_, work_;
  std::vector<std::string> old_;  ///< entries of the result, or of its remains, that is there.
  bool whole_ = false;            ///< a result is there and complete.
  bool made_folder_ = false;
  bool keep_ = false;
  int lock_ = -1;
};

}  // namespace faultsim
