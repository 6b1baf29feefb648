// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/detail/command.h"

#include <gtest/gtest.h>

#include "pacs/node.h"
#include "pacs/query.h"

namespace glisson::pacs {
namespace {

using namespace detail;

TEST(Command, ReadsWhatItWrites) {
  Command c = Command::of(MoveRequest, 7, "1.2.840.10008.5.1.4.1.2.2.2");
  c.title(Destination, "ODD").word(Priority, 2).word(DataSetType, 1);
  const std::string bytes = c.encoded();
  EXPECT_EQ(bytes.size() % 2, 0u);
  const Command back = Command::decoded(bytes);
  EXPECT_EQ(back.text(AffectedClass), "1.2.840.10008.5.1.4.1.2.2.2");
  EXPECT_EQ(back.text(Destination), "ODD");
  EXPECT_EQ(back.word(MessageId), 7);
  EXPECT_TRUE(back.hasData());
  EXPECT_EQ(back.encoded(), bytes);
  // The group's length counts what follows it.
  EXPECT_EQ(static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]), bytes.size() - 12);
}

TEST(Command, AnswersWithTheNumbersOfTheRequest) {
  Command request = Command::of(StoreRequest, 300, "1.2.3");
  request.uid(AffectedInstance, "1.2.3.4").word(DataSetType, 1);
  const Command answer = Command::answerTo(request, 0xa700);
  EXPECT_EQ(answer.word(Field), StoreResponse);
  EXPECT_EQ(answer.word(RespondedTo), 300);
  EXPECT_EQ(answer.word(Status), 0xa700);
  EXPECT_EQ(answer.text(AffectedInstance), "1.2.3.4");
  EXPECT_FALSE(answer.hasData());
}

TEST(Command, EveryCutAndFlippedByteIsReadOrRefused) {
  Command c = Command::of(StoreRequest, 1, "1.2.840.10008.5.1.4.1.1.4");
  const std::string bytes = c.uid(AffectedInstance, "1.2.3.4.5").word(DataSetType, 1).encoded();
  int refused = 0;
  const auto tried = [&](const std::string& b) {
    try {
      Command::decoded(b).encoded();
    } catch (const NetworkError&) {
      ++refused;
    }
  };
  for (std::size_t n = 0; n < bytes.size(); ++n) tried(bytes.substr(0, n));
  EXPECT_GT(refused, 0);
  for (std::size_t n = 0; n < bytes.size(); ++n)
    for (int bit = 0; bit < 8; ++bit) {
      std::string b = bytes;
      b[n] = static_cast<char>(b[n] ^ (1 << bit));
      tried(b);
    }
  EXPECT_THROW(Command::decoded(std::string(largestCommand + 8, '\0')), NetworkError);
  // A length of 4 GB takes no memory.
  EXPECT_THROW(Command::decoded(std::string("\0\0\0\1\xff\xff\xff\xff", 8)), NetworkError);
}

TEST(DateRange, TakesDaysAndRangesThatExist) {
  EXPECT_EQ(dateRange("20240229"), "20240229");
  EXPECT_EQ(dateRange("2024-02-29"), "20240229");
  EXPECT_EQ(dateRange("20240101-20240131"), "20240101-20240131");
  EXPECT_EQ(dateRange("2024-01-01..2024-01-31"), "20240101-20240131");
  EXPECT_EQ(dateRange("-20240131"), "-20240131");
  EXPECT_EQ(dateRange("2024-01-01.."), "20240101-");
  for (const char* wrong :
       {"", "-", "..", "20230229", "2024-13-01", "20240131-20240101", "yesterday", "2024", "20240101-x", "*"})
    EXPECT_THROW(dateRange(wrong), BadInput) << wrong;
}

}  // namespace
}  // namespace glisson::pacs
