#include "campaign/scheduler/wire.h"

#include <cstring>
#include <tuple>
#include <type_traits>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

// What of a struct is written, and read: the same list, so that they cannot differ.
template <typename First, typename Second>
auto members(std::pair<First, Second>& p) {
  return std::tie(p.first, p.second);
}
auto members(BaseScene& s) { return std::tie(s.source, s.document); }
auto members(CaseInput& c) { return std::tie(c.id, c.scene, c.position, c.changes, c.identity); }
auto members(RunRecord& r) {
  return std::tie(r.case_id, r.status, r.reason, r.signal, r.exit_code, r.log_tail, r.host, r.rank,
                  r.wall_seconds, r.final, r.has_fields, r.fields_only);
}
auto members(OperatorRecord& r) {
  return std::tie(r.fingerprint, r.from_cache, r.seconds, r.unknowns, r.jump_unknowns, r.bytes,
                  r.peak_bytes);
}
auto members(JobEvents::Completed& c) { return std::tie(c.run, c.result); }
auto members(JobEvents::Failure& f) { return std::tie(f.run, f.in_operator); }
auto members(JobEvents& e) {
  return std::tie(e.completed, e.failed, e.returned, e.operators, e.building);
}
auto members(message::Hello& m) { return std::tie(m.host, m.cores); }
auto members(message::Trouble& m) { return std::tie(m.text); }
auto members(message::Work& m) {
  return std::tie(m.task.family, m.task.time_limit, m.task.operator_time_limit,
                  m.task.operator_seconds, m.task.memory_limit, m.task.threads, m.task.keep_fields,
                  m.task.fields_folder, m.scenes, m.cases);
}

/// Appends values.
class Writer {
 public:
  template <typename Plain>
  requires(std::is_arithmetic_v<Plain> || std::is_enum_v<Plain>) void operator()(
      const Plain& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void operator()(const std::string& text) {
    (*this)(static_cast<std::uint64_t>(text.size()));
    bytes_ += text;
  }
  template <typename Value>
  void operator()(const std::optional<Value>& value) {
    (*this)(value.has_value());
    if (value) (*this)(*value);
  }
  template <typename Value>
  void operator()(const std::vector<Value>& values) {
    (*this)(static_cast<std::uint64_t>(values.size()));
    for (const Value& value : values) (*this)(value);
  }
  template <typename Struct>
  requires(std::is_class_v<Struct>) void operator()(const Struct& value) {
    std::apply([this](const auto&... each) { ((*this)(each), ...); },
               members(const_cast<Struct&>(value)));
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  template <typename Plain>
  requires(std::is_arithmetic_v<Plain> || std::is_enum_v<Plain>) void operator()(Plain& value) {
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
  }
  void operator()(std::string& text) { text = take(size()); }
  template <typename Value>
  void operator()(std::optional<Value>& value) {
    bool has = false;
    (*this)(has);
    if (has) (*this)(value.emplace());
  }
  template <typename Value>
  void operator()(std::vector<Value>& values) {
    const std::size_t n = size();
    values.clear();
    for (std::size_t k = 0; k < n; ++k) (*this)(values.emplace_back());
  }
  template <typename Struct>
  requires(std::is_class_v<Struct>) void operator()(Struct& value) {
    std::apply([this](auto&... each) { ((*this)(each), ...); }, members(value));
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  std::size_t size() {
    std::uint64_t n = 0;
    (*this)(n);
    FAULTSIM_DEMAND(n <= bytes_.size(), n, " of ", bytes_.size());
    return static_cast<std::size_t>(n);
  }
  std::string_view take(std::size_t n) {
    FAULTSIM_DEMAND(n <= bytes_.size(), n, " of ", bytes_.size());
    const std::string_view taken = bytes_.substr(0, n);
    bytes_.remove_prefix(n);
    return taken;
  }
  std::string_view bytes_;
};

template <std::size_t... Indices>
void read_alternative(std::size_t index, Reader& reader, Message& message,
                      std::index_sequence<Indices...>) {
  FAULTSIM_DEMAND(index < sizeof...(Indices), "message of unknown kind ", index);
  ((index == Indices ? reader(message.emplace<Indices>()) : void()), ...);
}

}  // namespace

std::string encode(const Message& message) {
  Writer writer;
  writer(static_cast<std::uint8_t>(message.index()));
  std::visit(writer, message);
  return writer.take();
}

Message decode(std::string_view bytes) {
  Reader reader(bytes);
  std::uint8_t index = 0;
  reader(index);
  Message message;
  read_alternative(index, reader, message,
                   std::make_index_sequence<std::variant_size_v<Message>>());
  FAULTSIM_DEMAND(reader.at_end(), "bytes behind a message of kind ", index);
  return message;
}

}  // namespace faultsweep
