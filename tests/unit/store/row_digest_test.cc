#include "campaign/store/row_digest.h"

#include <gtest/gtest.h>

namespace faultsweep {
namespace {

const std::uint64_t kA = RowDigest::column_key("t", "a"), kB = RowDigest::column_key("t", "b");

template <typename A, typename B>
void add_row(RowDigest& digest, const A& a, const B& b) {
  digest.add(kA, a);
  digest.add(kB, b);
  digest.end_row();
}

template <typename Value>
std::string of(const Value& value) {
  RowDigest digest;
  digest.add(kA, value);
  digest.end_row();
  return digest.text();
}

TEST(RowDigest, IsTheSameInAnyOrderOfRowsAndColumns) {
  RowDigest forth, back;
  add_row(forth, 1, 0.5);
  add_row(forth, 2, "two");
  back.add(kB, "two");
  back.add(kA, 2);
  back.end_row();
  add_row(back, 1, 0.5);
  EXPECT_EQ(forth.text(), back.text());
}

TEST(RowDigest, NoticesWhatMovesBetweenRowsColumnsAndKinds) {
  RowDigest digest, rows, columns, twice;
  add_row(digest, 1, 3);
  add_row(digest, 2, 4);
  add_row(rows, 1, 4);
  add_row(rows, 2, 3);
  EXPECT_NE(digest.text(), rows.text());
  add_row(columns, 3, 1);
  add_row(columns, 4, 2);
  EXPECT_NE(digest.text(), columns.text());
  for (int k = 0; k < 2; ++k) add_row(twice, 1, 3);
  EXPECT_NE(twice.text(), RowDigest().text());
  EXPECT_NE(of(1), of(1.0));
  EXPECT_NE(of(1), of("1"));
  EXPECT_NE(RowDigest::column_key("t", "a"), RowDigest::column_key("u", "a"));
}

TEST(RowDigest, ReadsValuesAsTheyComeBack) {
  EXPECT_EQ(of(-0.0), of(0.0));
  EXPECT_EQ(of(true), of(Cell(std::int64_t{1})));
  EXPECT_EQ(of(0.1), of(Cell(0.1)));
  EXPECT_EQ(of("text"), of(Cell(std::string("text"))));
  EXPECT_EQ(of(std::optional<double>()), of(Cell()));
  EXPECT_NE(of(std::optional<double>()), of(0.0));
}

}  // namespace
}  // namespace faultsweep
