#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace faultsweep {

class Connection;
class RowDigest;

/// Checksums over the rows of results and campaigns (schemas/store_8.sql, store_14.sql). What
/// counts as a result is read from the schema: the rows of every table with a column case_id, but
/// for the tables that go on changing once a case is decided (campaign_cases, runs); of these, the
/// run that decided it.
class Checksums {
 public:
  explicit Checksums(Connection& connection);
  ~Checksums();
  Checksums(const Checksums&) = delete;
  Checksums& operator=(const Checksums&) = delete;

  /// Whether the store is new enough to have any.
  static bool exist(Connection& connection);
  /// Writes the checksum of a case that has a result. Within the transaction that wrote the result.
  /// @param rows  all rows that it has in the tables of results, as they were bound.
  void seal_result(std::int64_t case_id, RowDigest rows);
  void seal_campaign(std::int64_t campaign);
  /// Makes all checksums anew for the present schema. In one transaction; about 0.3 ms per case.
  void seal_all();
  /// Whether they cover the present schema.
  bool are_current() const;
  /// What differs from its checksum, one sentence each. Linear in the size of the store. Nothing
  /// where !are_current().
  std::vector<std::string> problems() const;

 private:
  struct Rows;
  std::string of_result(std::int64_t case_id, RowDigest rows) const;
  RowDigest stored_rows(std::int64_t case_id) const;  ///< of results.
  std::string of_campaign(std::int64_t campaign) const;
  Connection& connection_;
  std::vector<Rows> tables_;              ///< of results: the rows of one case.
  std::vector<Rows> decided_, campaign_;  ///< a case and its run; what a campaign consists of.
};

}  // namespace faultsweep
