#pragma once

#include <cstdint>
#include <string_view>

#include "simulator/gmsh/file_problems.h"

namespace faultsim {

/// The numbers of a section, record by record: lines of text, or bytes. What cannot be read is
/// said once for each record, and reads as 0.
class Records {
 public:
  virtual ~Records() = default;
  Records() = default;
  Records(const Records&) = delete;
  Records& operator=(const Records&) = delete;

  /// Goes on to the next record; false where the section ends.
  /// @param form  what it holds, for messages: "x, y and z". Lives as long as the record.
  virtual bool next(std::string_view form) = 0;
  /// The next numbers of the record: an int of 4 bytes; a number of things or tag from 0 on, of 8
  /// bytes; a finite double.
  virtual std::int64_t integer() = 0;
  virtual std::int64_t count() = 0;
  virtual double real() = 0;
  /// Leaves out counts or doubles, whatever they are.
  virtual void skip(int n_numbers) = 0;
  /// Whether all numbers of the record so far could be read.
  virtual bool is_sound() const = 0;
  /// The same at the record's end: nothing else may follow.
  virtual bool is_whole() = 0;
  /// Whether the section may go on with as many records.
  /// @param n_bytes  of each, in binary files.
  virtual bool may_hold(std::int64_t n_records, int n_bytes) const = 0;
  /// Whether the section has ended; as next(), but stays.
  virtual bool is_at_end() = 0;
  /// Of the record, in the file.
  virtual int place() const = 0;
};

/// A part of a file.
struct FilePart {
  std::string_view bytes;
  int byte = 0;  ///< where it begins.
  int line = 0;  ///< the number of its first line.
};

/// Records that are lines; empty ones mean nothing.
class TextRecords final : public Records {
 public:
  /// @param part  begins and ends with the begin and end of a line.
  TextRecords(FilePart part, FileProblems& problems)
      : rest_(part.bytes), next_byte_(part.byte), next_line_(part.line), problems_(problems) {}

  bool next(std::string_view form) override;
  std::int64_t integer() override;
  std::int64_t count() override;
  double real() override;
  void skip(int n_numbers) override;
  bool is_sound() const override { return is_sound_; }
  bool is_whole() override;
  bool may_hold(std::int64_t n_records, int n_bytes) const override;
  bool is_at_end() override;
  int place() const override { return problems_.is_binary() ? byte_ : line_; }
  /// The line, without blanks around it.
  std::string_view line() const { return text_; }
  /// What of the line has not been read, without blanks around it.
  std::string_view rest_of_line();

 private:
  void skip_empty_lines();
  std::string_view word();
  template <typename What>
  void refuse(const What& what);
  std::int64_t whole_number(std::int64_t least, std::int64_t most, const char* range);

  std::string_view rest_;  ///< lines that follow.
  int next_byte_, next_line_;
  std::string_view text_, left_;  ///< the line, and what of it is still to be read.
  int byte_ = 0, line_ = 0;
  std::string_view form_;
  bool is_sound_ = true;
  FileProblems& problems_;
};

/// Records that stand in bytes one behind the other.
class BinaryRecords final : public Records {
 public:
  /// @param is_swapped  numbers have their most significant byte first.
  BinaryRecords(FilePart part, bool is_swapped, FileProblems& problems)
      : rest_(part.bytes), byte_(part.byte), is_swapped_(is_swapped), problems_(problems) {}

  bool next(std::string_view form) override;
  std::int64_t integer() override;
  std::int64_t count() override;
  double real() override;
  void skip(int n_numbers) override;
  bool is_sound() const override { return is_sound_; }
  bool is_whole() override { return is_sound_; }
  bool may_hold(std::int64_t n_records, int n_bytes) const override;
  bool is_at_end() override { return rest_.empty(); }
  int place() const override { return record_; }

 private:
  template <typename Number>
  Number take();
  template <typename What>
  void refuse(const char* cure, const What& what);

  std::string_view rest_;
  int byte_;
  bool is_swapped_;
  int record_ = 0;
  std::string_view form_;
  bool is_sound_ = true;
  FileProblems& problems_;
};

}  // namespace faultsim
