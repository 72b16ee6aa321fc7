#include "simulator/result/result_bytes.h"

#include <cmath>
#include <cstring>

#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/result/result_fields.h"

namespace faultsim {
namespace {

constexpr std::size_t kPrint = 32;  // characters of a fingerprint

template <typename Value>
concept PlainValue = std::is_arithmetic_v<Value> || std::is_enum_v<Value>;

class ByteWriter {
 public:
  explicit ByteWriter(std::string& bytes) : bytes_(bytes) {}
  template <typename Value>
  void operator()(const Field&, const Value& value) {
    add(value);
  }

 private:
  template <PlainValue Value>
  void add(const Value& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void add(const std::string& text) {
    add(text.size());
    bytes_ += text;
  }
  template <typename Value>
  void add(const std::optional<Value>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  template <typename Value>
  void add(const std::vector<Value>& values) {
    add(values.size());
    for (const Value& value : values) add(value);
  }
  template <typename Struct>
  requires std::is_class_v<Struct>
  void add(const Struct& value) { for_each_field(value, *this); }

  std::string& bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  template <typename Value>
  void operator()(const Field& field, Value& value) {
    take(field, value);
  }
  std::size_t n_left() const { return bytes_.size(); }

 private:
  [[noreturn]] static void refuse(const Field& field, const char* what) {
    throw StorageError(concat("\"", field.key, "\" ", what));
  }
  template <PlainValue Value>
  Value plain(const Field& field) {
    if (sizeof(Value) > bytes_.size()) refuse(field, "is cut off");
    Value value;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  void take(const Field& field, double& value) {
    value = plain<double>(field);
    if (!std::isfinite(value) && !(field.may_be_nan && !std::isinf(value)))
      refuse(field, "is not a number");
  }
  void take(const Field& field, int& value) { value = plain<int>(field); }
  void take(const Field& field, bool& value) {
    const auto byte = plain<unsigned char>(field);
    if (byte > 1) refuse(field, "is neither true nor false");
    value = byte == 1;
  }
  void take(const Field& field, Outcome& value) {
    const int number = plain<int>(field);
    if (number < 0 || number >= std::ssize(words(Outcome()))) refuse(field, "is not an outcome");
    value = static_cast<Outcome>(number);
  }
  /// Every element takes a byte at least, so that a wrong size asks for no memory.
  std::size_t size(const Field& field) {
    const auto n = plain<std::size_t>(field);
    if (n > bytes_.size()) refuse(field, "is longer than what there is");
    return n;
  }
  void take(const Field& field, std::string& text) {
    const std::size_t n = size(field);
    text = bytes_.substr(0, n);
    bytes_.remove_prefix(n);
  }
  template <typename Value>
  void take(const Field& field, std::optional<Value>& value) {
    bool has = false;
    take(field, has);
    value.reset();
    if (has) take(field, value.emplace());
  }
  template <typename Value>
  void take(const Field& field, std::vector<Value>& values) {
    const std::size_t n = size(field);
    values.clear();
    for (std::size_t k = 0; k < n; ++k) take(field, values.emplace_back());
  }
  template <typename Struct>
  requires std::is_class_v<Struct>
  void take(const Field&, Struct& value) { for_each_field(value, *this); }

  std::string_view bytes_;
};

/// Names and kinds of all fields, in order.
class Layout {
 public:
  template <typename Value>
  void operator()(const Field& field, const Value& value) {
    text_ += field.key;
    add(value);
    text_ += ' ';
  }
  std::string print() const { return fingerprint(text_); }

 private:
  void add(double) { text_ += ":d"; }
  void add(int) { text_ += ":i"; }
  void add(bool) { text_ += ":b"; }
  void add(Outcome) { text_ += ":o"; }
  void add(const std::string&) { text_ += ":s"; }
  template <typename Value>
  void add(const std::optional<Value>&) {
    text_ += '?';
    add(Value{});
  }
  template <typename Value>
  void add(const std::vector<Value>&) {
    text_ += '*';
    add(Value{});
  }
  template <typename Struct>
  requires std::is_class_v<Struct>
  void add(const Struct& value) {
    text_ += '{';
    for_each_field(value, *this);
    text_ += '}';
  }
  std::string text_;
};

}  // namespace

const std::string& result_layout() {
  static const std::string print = [] {
    Layout all;
    const CaseResult empty;
    for_each_field(empty, all);
    return all.print();
  }();
  return print;
}

std::string result_to_bytes(const CaseResult& result) {
  std::string bytes = result_layout() + std::string(kPrint, ' ');
  ByteWriter writer(bytes);
  for_each_field(result, writer);
  bytes.replace(kPrint, kPrint, fingerprint(std::string_view(bytes).substr(2 * kPrint)));
  return bytes;
}

void require_sound_result(std::string_view bytes) {
  if (bytes.size() < 2 * kPrint) throw StorageError("the result is cut off");
  if (bytes.substr(0, kPrint) != result_layout())
    throw StorageError(
        "the result has other fields than this program knows: another build wrote it");
  if (bytes.substr(kPrint, kPrint) != fingerprint(bytes.substr(2 * kPrint)))
    throw StorageError("the result is cut off or was changed on its way: its checksum differs");
}

CaseResult result_from_bytes(std::string_view bytes) {
  require_sound_result(bytes);
  return with_context([] { return "reading a result"; },
                      [&] {
                        ByteReader reader(bytes.substr(2 * kPrint));
                        CaseResult result;
                        for_each_field(result, reader);
                        if (reader.n_left() > 0) throw StorageError("there are bytes after it");
                        return result;
                      });
}

}  // namespace faultsim
