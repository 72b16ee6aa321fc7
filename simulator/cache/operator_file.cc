#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "simulator/cache/operator_cache.h"
#include "simulator/cache/operator_tables.h"
#include "simulator/cache/sealed_file.h"
#include "simulator/cache/table_archive.h"
#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/files/atomic_file.h"

namespace faultsim {
namespace {

constexpr SealedFormat kOperatorFile{.name = "operator", .version = 3};

FaultOperator decode_operator(const SealedContent& content) {
  OperatorTables tables;
  for_each_table(tables, ReadTables{content.file()});
  FaultOperator op = from_tables(tables);
  const int n = op.geometry.n_dofs;
  const double* h =
      content.mapped(kStiffnessTable, static_cast<hsize_t>(n), static_cast<hsize_t>(n));
  op.compliance = std::make_shared<DenseCompliance>(StoredMatrix(h, n, n, content.mapping()));
  return op;
}

/// Bit patterns of all tables and of H.
std::vector<std::string> operator_digests(const OperatorTables& tables, const FaultOperator& op) {
  std::vector<std::string> result;
  for_each_table(tables, DigestTables{result});
  result.push_back(fingerprint(op.h().data(), op.h().size() * sizeof(double)));
  return result;
}

void check_content(const FaultOperator& op, const OperatorTables& tables) {
  FAULTSIM_DEMAND(!op.fingerprint.empty() && op.fingerprint.find('/') == std::string::npos &&
                      op.fingerprint[0] != '.',
                  "fingerprint '", op.fingerprint, "'");
  FAULTSIM_DEMAND(op.compliance->size() == op.geometry.n_dofs && op.h().allFinite(), "H of size ",
                  op.compliance->size(), " for ", op.geometry.n_dofs,
                  " dofs, or a value that is not finite");
  for_each_table(tables, [](const char* path, const auto& values, int, const char*, const char*) {
    if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<double>>) {
      FAULTSIM_DEMAND(std::all_of(values.begin(), values.end(),
                                  [](double value) { return std::isfinite(value); }),
                      path, " holds a value that is not finite");
    }
  });
  try {
    from_tables(tables);
  } catch (const StorageError& error) {
    throw_internal("the operator is consistent", error.what(), __FILE__, __LINE__);
  }
}

}  // namespace

void write_operator(const FaultOperator& op, const std::filesystem::path& folder) {
  const OperatorTables tables = to_tables(op);
  check_content(op, tables);
  create_folders(folder);
  write_sealed(
      cached_file(folder, op.fingerprint), kOperatorFile,
      [&](hid_t file) {
        for_each_table(tables, WriteTables{file});
        const auto n = static_cast<hsize_t>(op.geometry.n_dofs);
        hdf5::write_array(file, kStiffnessTable, {n, n}, op.h().data(),
                          {"N/m", "H, condensed stiffness"});
      },
      [&](const SealedContent& content) {
        const FaultOperator copy = decode_operator(content);
        if (operator_digests(to_tables(copy), copy) != operator_digests(tables, op)) {
          throw StorageError("what was read is not what was written");
        }
      });
}

std::optional<FaultOperator> read_operator(const std::filesystem::path& folder,
                                           const std::string& fingerprint, std::string* remark) {
  std::optional<FaultOperator> op;
  const auto decode = [&](const SealedContent& content) {
    FaultOperator found = decode_operator(content);
    if (found.fingerprint != fingerprint) {
      throw StorageError("it holds the operator " + found.fingerprint);
    }
    op = std::move(found);
  };
  read_sealed(cached_file(folder, fingerprint), kOperatorFile, decode, remark);
  return op;
}

}  // namespace faultsim
