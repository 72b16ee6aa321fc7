#include "simulator/result/result_bytes.h"

#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/result/result_json.h"
#include "tests/campaign/made_up_result.h"

namespace faultsim {
namespace {

using ::testing::HasSubstr;

CaseResult made_up_result() { return faultsweep::testing::made_up_result_with_events(0.8); }

constexpr std::size_t kHead = 64;

/// As a program would write it that has a bug rather than a broken pipe.
std::string sealed(std::string bytes) {
  return bytes.replace(32, 32, fingerprint(std::string_view(bytes).substr(kHead)));
}

TEST(ResultBytes, EveryFieldTravelsBitForBit) {
  CaseResult result = made_up_result();
  result.steps[3].faults[1].chi_max = 0.1 + 0.2;
  const CaseResult back = result_from_bytes(result_to_bytes(result));
  EXPECT_EQ(result_to_json(back), result_to_json(result));
  EXPECT_EQ(back.whole, result.whole);
  EXPECT_EQ(back.steps[3].faults[1].chi_max, 0.1 + 0.2);
  EXPECT_EQ(result_to_bytes(back), result_to_bytes(result));
}

TEST(ResultBytes, EveryCutIsRefused) {
  const std::string bytes = result_to_bytes(made_up_result());
  for (std::size_t n = 0; n < bytes.size(); n += n < 200 ? 1 : 37) {
    EXPECT_THROW(result_from_bytes(std::string_view(bytes).substr(0, n)), StorageError) << n;
  }
  EXPECT_THROW(result_from_bytes(bytes + "x"), StorageError);
}

TEST(ResultBytes, EveryFlippedBitIsRefused) {
  const std::string bytes = result_to_bytes(made_up_result());
  for (std::size_t n = 0; n < bytes.size(); n += 11) {
    std::string flipped = bytes;
    flipped[n] = static_cast<char>(flipped[n] ^ (1 << n % 8));
    EXPECT_THROW(result_from_bytes(flipped), StorageError) << n;
  }
}

/// Whatever a broken program seals, it is a result or a reason, and no crash.
TEST(ResultBytes, SealedNonsenseIsAResultOrAReason) {
  const std::string bytes = result_to_bytes(made_up_result());
  std::mt19937 random(15);
  int n_refused = 0;
  for (int k = 0; k < 3000; ++k) {
    std::string changed = bytes;
    for (int n = 0; n < 1 + k % 3; ++n) {
      changed[kHead + random() % (bytes.size() - kHead)] = static_cast<char>(random());
    }
    if (k % 5 == 0) changed.resize(kHead + random() % (bytes.size() - kHead));
    try {
      result_to_json(result_from_bytes(sealed(changed)));
    } catch (const StorageError&) {
      ++n_refused;
    }
  }
  EXPECT_GT(n_refused, 600);
}

TEST(ResultBytes, NoNumberIsRefusedByName) {
  CaseResult result = made_up_result();
  result.pressure_margin = std::numeric_limits<double>::quiet_NaN();  // there is none
  EXPECT_NO_THROW(result_from_bytes(result_to_bytes(result)));
  result.stages[1].chi_bar = std::numeric_limits<double>::quiet_NaN();
  try {
    result_from_bytes(result_to_bytes(result));
    ADD_FAILURE() << "NaN came through";
  } catch (const StorageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("\"chi_bar\" is not a number"));
  }
}

TEST(ResultBytes, AProgramWithOtherFieldsIsRefused) {
  std::string bytes = result_to_bytes(made_up_result());
  bytes[0] = bytes[0] == 'a' ? 'b' : 'a';
  try {
    require_sound_result(bytes);
    ADD_FAILURE() << "another build's result was taken";
  } catch (const StorageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("another build wrote it"));
  }
}

}  // namespace
}  // namespace faultsim
