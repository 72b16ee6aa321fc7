#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "simulator/cache/sealed_file.h"
#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/hdf5/datasets.h"
#include "simulator/model/stored_matrix.h"

/// The tables of a sealed file are listed once, by a function of a value and of an archive that
/// reads them, writes them or takes their bit patterns, in the order of the list. An archive has
///
///   values(path, cells, about)                a vector of the numbers or texts in a tuple
///   list(path, items, row, about)             a row per item; reading makes as many as there are
///   rows(path, items, row, about)             a row per item that is there
///   matrix(path, m, n_rows, n_columns, about) a vector of its entries, column by column
///   array(path, m, n_rows, n_columns, about)  a dataset with a row per column of m, which stays in
///                                             the mapped file
///
/// where row(item) is a number, a text, a vector, or several as cells(). Reading throws
/// StorageError for a table of another length. Private to `cache`.
namespace faultsim {

/// The cells of a row: by reference what is an lvalue.
template <typename... Cell>
std::tuple<Cell...> cells(Cell&&... cell) {
  return {std::forward<Cell>(cell)...};
}

/// How many items each of some lists has, as a cell: reading makes them as many.
template <typename... List>
struct Length {
  std::tuple<List&...> lists;
  operator int() const { return static_cast<int>(std::get<0>(lists).size()); }
  const Length& operator=(int n) const {
    constexpr int kMost = 1 << 24;  // far above any fault, far below what fills a memory
    if (n < 0 || n > kMost) throw StorageError(concat("a list of ", n, " items"));
    std::apply([n](auto&... list) { (list.resize(static_cast<std::size_t>(n)), ...); }, lists);
    return *this;
  }
};
template <typename... List>
Length<List...> length(List&... lists) {
  return {{lists...}};
}

/// Pointers to the items of a list that each of some has, in order.
template <typename Outer, typename List>
auto items_of(Outer& outer, List list) {
  std::vector<decltype(std::invoke(list, *std::begin(outer)).data())> all;
  for (auto& one : outer) {
    for (auto& item : std::invoke(list, one)) all.push_back(&item);
  }
  return all;
}

namespace table {

template <typename Row>
concept Tuple = requires {
  std::tuple_size<std::remove_cvref_t<Row>>::value;
};
template <typename Row>
concept Vector = requires {
  std::remove_cvref_t<Row>::SizeAtCompileTime;
};

template <typename Row, typename Visit>
void for_each_cell(Row&& row, const Visit& visit) {
  if constexpr (Tuple<Row>) {
    std::apply([&](auto&&... cell) { (visit(cell), ...); }, row);
  } else if constexpr (Vector<Row>) {
    for (auto& cell : row) visit(cell);
  } else {
    visit(row);
  }
}

template <typename Row>
constexpr auto first_cell(const Row& row) {
  if constexpr (Tuple<Row>) {
    return std::get<0>(row);
  } else if constexpr (Vector<Row>) {
    return row[0];
  } else {
    return row;
  }
}

/// An item, or what a pointer to one points to.
template <typename Item>
Item& target(Item& item) {
  return item;
}
template <typename Item>
Item& target(Item* item) {
  return *item;
}

/// What of the rows of some items is stored.
template <typename Items, typename Row>
struct Shape {
  using Cells = std::remove_cvref_t<
      std::invoke_result_t<Row, decltype(target(*std::begin(std::declval<Items&>())))>>;
  using Cell = decltype(first_cell(std::declval<Cells>()));
  using Value = std::conditional_t<std::is_same_v<Cell, std::string>, std::string,
                                   std::conditional_t<std::is_floating_point_v<Cell>, double, int>>;
  static constexpr hsize_t n_columns() {
    if constexpr (Tuple<Cells>) return std::tuple_size_v<Cells>;
    if constexpr (Vector<Cells>) return Cells::SizeAtCompileTime;
    return 1;
  }
};

}  // namespace table

class TableReader {
 public:
  static constexpr bool kReads = true;
  explicit TableReader(const SealedContent& content) : content_(content) {}

  template <typename Cells>
  void values(const char* path, Cells to, const hdf5::About& = {}) const {
    using Value = typename table::Shape<std::span<Cells>, std::identity>::Value;
    scatter(path, std::span(&to, 1), std::identity(), hdf5::read<Value>(content_.file(), path, 1));
  }
  template <typename Items, typename Row>
  void list(const char* path, Items& items, Row row, const hdf5::About& = {}) const {
    const auto values = read<Items, Row>(path);
    items.resize(values.size() / table::Shape<Items, Row>::n_columns());
    scatter(path, items, row, values);
  }
  template <typename Items, typename Row>
  void rows(const char* path, Items&& items, Row row, const hdf5::About& = {}) const {
    scatter(path, items, row, read<Items, Row>(path));
  }
  template <typename Matrix>
  void matrix(const char* path, Matrix& m, Eigen::Index n_rows, Eigen::Index n_columns,
              const hdf5::About& = {}) const {
    const std::vector<double> values = hdf5::read<double>(content_.file(), path, 1);
    if (static_cast<Eigen::Index>(values.size()) != n_rows * n_columns) disagree(path);
    m = Eigen::Map<const Matrix>(values.data(), n_rows, n_columns);
  }
  template <typename Scalar>
  void array(const char* path, StoredMatrixOf<Scalar>& m, Eigen::Index n_rows,
             Eigen::Index n_columns, const hdf5::About& = {}) const {
    const Scalar* values = content_.mapped<Scalar>(path, static_cast<hsize_t>(n_columns),
                                                   static_cast<hsize_t>(n_rows));
    m = {values, n_rows, n_columns, content_.mapping()};
  }

 private:
  [[noreturn]] static void disagree(const char* path) {
    throw StorageError(concat("the tables disagree: the length of ", path));
  }
  template <typename Items, typename Row>
  auto read(const char* path) const {
    using Shape = table::Shape<Items, Row>;
    return hdf5::read<typename Shape::Value>(content_.file(), path, Shape::n_columns());
  }
  template <typename Items, typename Row, typename Values>
  static void scatter(const char* path, Items&& items, const Row& row, const Values& values) {
    auto next = values.begin();
    const auto take = [&](auto&& cell) {
      if (next == values.end()) disagree(path);
      using Cell = std::remove_reference_t<decltype(cell)>;
      if constexpr (std::is_enum_v<Cell>) {
        cell = static_cast<Cell>(*next++);
      } else {
        cell = *next++;
      }
    };
    for (auto&& item : items) table::for_each_cell(std::invoke(row, table::target(item)), take);
    if (next != values.end()) disagree(path);
  }

  const SealedContent& content_;
};

/// Hands every table to sink(path, values, sizes, about), sizes being those of its dimensions.
template <typename Sink>
class TableGatherer {
 public:
  static constexpr bool kReads = false;
  explicit TableGatherer(Sink sink) : sink_(std::move(sink)) {}

  template <typename Cells>
  void values(const char* path, const Cells& from, const hdf5::About& about = {}) const {
    gather(path, std::span(&from, 1), std::identity(), 1, about);
  }
  template <typename Items, typename Row>
  void list(const char* path, const Items& items, Row row, const hdf5::About& about = {}) const {
    rows(path, items, row, about);
  }
  template <typename Items, typename Row>
  void rows(const char* path, Items&& items, Row row, const hdf5::About& about = {}) const {
    gather(path, items, row, table::Shape<Items, Row>::n_columns(), about);
  }
  template <typename Matrix>
  void matrix(const char* path, const Matrix& m, Eigen::Index, Eigen::Index,
              const hdf5::About& about = {}) const {
    const auto n = static_cast<std::size_t>(m.size());
    sink_(path, std::span(m.data(), n), std::vector<hsize_t>{n}, about);
  }
  template <typename Scalar>
  void array(const char* path, const StoredMatrixOf<Scalar>& m, Eigen::Index n_rows,
             Eigen::Index n_columns, const hdf5::About& about = {}) const {
    const auto n = static_cast<std::size_t>(n_rows * n_columns);
    sink_(path, std::span(m.view().data(), n),
          std::vector<hsize_t>{static_cast<hsize_t>(n_columns), static_cast<hsize_t>(n_rows)},
          about);
  }

 private:
  template <typename Items, typename Row>
  void gather(const char* path, Items&& items, const Row& row, hsize_t n_columns,
              const hdf5::About& about) const {
    using Value = typename table::Shape<Items, Row>::Value;
    std::vector<Value> values;
    const auto put = [&](const auto& cell) { values.push_back(static_cast<Value>(cell)); };
    for (auto&& item : items) table::for_each_cell(std::invoke(row, table::target(item)), put);
    std::vector<hsize_t> sizes = {values.size() / n_columns};
    if (n_columns > 1) sizes.push_back(n_columns);
    sink_(path, values, sizes, about);
  }

  Sink sink_;
};

/// The bit patterns of all tables.
template <typename Tables, typename Value>
std::string digest_of(const Tables& tables, const Value& value) {
  std::string all;
  tables(value, TableGatherer([&](const char*, const auto& values, const auto&, const auto&) {
           using Entry = std::remove_cvref_t<decltype(values[0])>;
           if constexpr (std::is_same_v<Entry, std::string>) {
             std::string joined;
             for (const std::string& text : values) joined += text + '\0';
             all += fingerprint(joined);
           } else {
             all += fingerprint(values.data(), values.size() * sizeof(Entry));
           }
         }));
  return all;
}

/// Writes a value and reads it back. Complete or not at all; throws StorageError (disk full, ...).
/// @tparam Tables  with kFormat, what it is called (kName), fingerprint_of(value), and the list of
///                 the tables as operator()(value, archive).
template <typename Tables, typename Value>
void write_tables(const std::filesystem::path& path, const Value& value,
                  const Tables& tables = {}) {
  write_sealed(
      path, Tables::kFormat,
      [&](hid_t file) {
        tables(value,
               TableGatherer([&](const char* table, const auto& values,
                                 const std::vector<hsize_t>& sizes, const hdf5::About& about) {
                 if constexpr (std::is_same_v<std::decay_t<decltype(values[0])>, std::string>) {
                   hdf5::write_texts(file, table, values);
                 } else {
                   hdf5::write_array(file, table, sizes, values.data(), about);
                 }
               }));
      },
      [&](const SealedContent& content) {
        Value copy;
        tables(copy, TableReader(content));
        if (digest_of(tables, copy) != digest_of(tables, value))
          throw StorageError("what was read is not what was written");
      });
}

/// Opens the file if it is there and holds the value of that fingerprint (read_sealed()).
template <typename Value, typename Tables>
std::optional<Value> read_tables(const std::filesystem::path& path, const std::string& fingerprint,
                                 std::string* remark, const Tables& tables = {}) {
  std::optional<Value> found;
  read_sealed(
      path, Tables::kFormat,
      [&](const SealedContent& content) {
        Value value;
        tables(value, TableReader(content));
        if (const std::string& name = Tables::fingerprint_of(value); name != fingerprint)
          throw StorageError(concat("it holds the ", Tables::kName, " ", name));
        found = std::move(value);
      },
      remark);
  return found;
}

}  // namespace faultsim
