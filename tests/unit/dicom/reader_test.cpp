// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>

#include "dicom/detail/reader_process.h"
#include "said.h"

namespace glisson::dicom {
namespace {

using test::DicomBytes;
using test::TemporaryFolder;
using testing::HasSubstr;

/// Uses another reader program while it lives.
class WithReader {
 public:
  explicit WithReader(const std::filesystem::path& program) : usual_(readerProgram()) { setReaderProgram(program); }
  ~WithReader() { setReaderProgram(usual_); }
  WithReader(const WithReader&) = delete;
  WithReader& operator=(const WithReader&) = delete;

 private:
  std::filesystem::path usual_;
};

/// An image that is not plain (its elements are out of order) and holds a word for the faulty reader.
DicomBytes odd(const std::string& word) {
  DicomBytes d;
  d.extra0008 = DicomBytes::element(0x0008103E, "LO", word) + DicomBytes::element(0x00080070, "LO", "maker");
  return d;
}

std::string saidOfFault(const std::string& word) {
  const WithReader faulty(GLISSON_FAULTY_READER);
  return saidOfBytes(odd(word).bytes());
}

TEST(ReaderProcess, oddFilesAreReadThereAndPlainOnesHere) {
  EXPECT_THAT(saidOfFault("no fault"), HasSubstr("[read]"));
  // Without a reader program plain files are read, and the others say what they need.
  const WithReader none("/no/such/glisson-reader");
  EXPECT_THAT(saidOfImage([](DicomBytes&) {}), HasSubstr("[read]"));
  EXPECT_THAT(saidOfBytes(odd("x").bytes()), HasSubstr("needs a reader process, which cannot be started"));
}

TEST(ReaderProcess, valuesAreThoseOfTheSameFileReadHere) {
  const TemporaryFolder folder;
  DicomBytes plain;
  plain.rescale = DicomBytes::element(0x00281052, "DS", "-7.25") + DicomBytes::element(0x00281053, "DS", "0.1");
  plain.pixels.clear();
  for (unsigned n = 0; n < 12; ++n) plain.pixels += DicomBytes::little(n * 4001, 2);
  DicomBytes strange = plain;
  strange.extra0008 = odd("x").extra0008;
  plain.write(folder / "plain");
  strange.write(folder / "strange");
  std::unique_ptr<IsolatedFile> process;
  EXPECT_FALSE(readHeaderSafely(folder / "plain", &process).isolated);
  EXPECT_FALSE(process);
  EXPECT_TRUE(readHeaderSafely(folder / "strange", &process).isolated);
  EXPECT_TRUE(process);
  const Series a = scan(folder / "plain").series.at(0);
  const Series b = scan(folder / "strange").series.at(0);
  EXPECT_EQ(readSeries(a).values, readSeries(b).values);
  EXPECT_TRUE(a.grid.sameGeometry(b.grid, 0.0));
  EXPECT_EQ(a.patientKey, b.patientKey);
}

TEST(ReaderProcess, crashesBecomeReasons) {
  EXPECT_THAT(saidOfFault("FAULT-CRASH"), HasSubstr("crash (signal SIGSEGV)"));
  EXPECT_THAT(saidOfFault("FAULT-ABORT"), HasSubstr("crash (signal SIGABRT)"));
  EXPECT_THAT(saidOfFault("FAULT-EXIT"), HasSubstr("ended the process that was decoding it"));
  EXPECT_THAT(saidOfFault("FAULT-FILE"), HasSubstr("crash (signal SIGXFSZ)"));
}

TEST(ReaderProcess, hangsEndAfterTheTimeThatTheFileMayTake) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(saidOfFault("FAULT-LOOP"), HasSubstr("takes longer to decode than its size allows"));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  EXPECT_GT(seconds.count(), 1.4);
}

TEST(ReaderProcess, memoryBeyondTheBudgetBecomesAReason) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer ends a program that runs out of memory in its own way";
#endif
  EXPECT_THAT(saidOfFault("FAULT-MEMORY"), HasSubstr("asks for more memory than 256 MiB"));
}

TEST(ReaderProcess, answersThatMakeNoSenseAreRefused) {
  EXPECT_THAT(saidOfFault("FAULT-LIE"), HasSubstr("a message that makes no sense"));
  EXPECT_THAT(saidOfFault("FAULT-HUGE"), HasSubstr("a message that makes no sense"));
}

TEST(ReaderProcess, oneBadFileSpoilsNoOther) {
  const WithReader faulty(GLISSON_FAULTY_READER);
  const TemporaryFolder folder;
  for (int k = 0; k < 20; ++k) {
    DicomBytes d = odd(k % 5 == 2 ? "FAULT-CRASH" : "fine");
    d.seriesUid = k % 5 == 2 ? "1.9" : "1.2.3.4";
    d.sopUid += std::to_string(k);
    d.position = "0\\0\\" + std::to_string(5 * (k - k / 5 - (k % 5 > 2 ? 1 : 0)));
    d.write(folder / ("f" + std::to_string(100 + k)));
  }
  const ScanResult found = scan(folder.path());
  EXPECT_EQ(found.skipped.size(), 4U);
  ASSERT_EQ(found.series.size(), 1U);
  EXPECT_EQ(found.series.front().files.size(), 16U);
  EXPECT_FALSE(found.series.front().error) << *found.series.front().error;
  EXPECT_EQ(readSeries(found.series.front()).grid.size.z(), 16);
}

TEST(ReaderProcess, limitsFollowTheSizeOfTheFile) {
  EXPECT_EQ(limitsFor(0, 0).memory_bytes, 256ULL << 20);
  EXPECT_EQ(limitsFor(1000, 0).memory_bytes, (256ULL << 20) + 3000);
  EXPECT_DOUBLE_EQ(limitsFor(0, 0).cpu_s, 1.5);
  EXPECT_DOUBLE_EQ(limitsFor(0, 64ULL << 20).cpu_s, 3.5);
}

}  // namespace
}  // namespace glisson::dicom
