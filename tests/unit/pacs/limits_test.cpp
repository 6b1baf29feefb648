// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <fstream>
#include <thread>

#include "dicom/file_layout.h"
#include "pacs/detail/identifier.h"
#include "pacs/detail/object_store.h"
#include "pacs/send.h"
#include "support/support.h"

namespace glisson::pacs {
namespace {

using namespace detail;

int freePort() {
  const int s = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in a{};
  a.sin_family = AF_INET;
  socklen_t size = sizeof(a);
  bind(s, reinterpret_cast<sockaddr*>(&a), size);
  getsockname(s, reinterpret_cast<sockaddr*>(&a), &size);
  close(s);
  return ntohs(a.sin_port);
}

/// An object of MR storage with a text of so many bytes, and no pixels.
void writeObject(const std::filesystem::path& file, const std::string& uid, std::size_t bytes) {
  std::string data = fileHead("1.2.840.10008.5.1.4.1.1.4", uid, "1.2.840.10008.1.2.1");
  data += std::string("\x08\x00\x18\x00UI", 6);
  const std::string value = uid.size() % 2 == 0 ? uid : uid + '\0';
  data += static_cast<char>(value.size());
  data += '\0';
  data += value;
  data += std::string("\x11\x00\x10\x00UT\0\0", 8);
  for (int n = 0; n < 4; ++n) data += static_cast<char>((bytes >> (8 * n)) & 0xff);
  data += std::string(bytes, ' ');
  std::ofstream(file, std::ios::binary) << data;
}

struct Running {
  explicit Running(const ReceiveOptions& o)
      : receiver(o), thread([this] { receiver.run(Progress({}, stop.get_token())); }) {}
  ~Running() { stop.request_stop(); }
  std::stop_source stop;
  Receiver receiver;
  std::jthread thread;
};

std::size_t filesIn(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(Titles, AreShortAndPlain) {
  for (const char* wrong : {"", "   ", "A\\B", "A\nB", "seventeen letters", "Ä"})
    EXPECT_THROW(checkTitle(wrong, "--called"), BadInput) << wrong;
  EXPECT_NO_THROW(checkTitle("SIXTEEN LETTERS!", "--called"));
}

TEST(Uids, AreDigitsAndDots) {
  for (const char* wrong : {"", ".1", "1.", "1..2", "1.2a", "../1", "1.2 "}) EXPECT_FALSE(isUid(wrong)) << wrong;
  EXPECT_TRUE(isUid("1.2.840.10008.1.1"));
  EXPECT_FALSE(isUid(std::string(65, '1')));
}

TEST(Identifier, KeepsTextAndDropsControlCharacters) {
  const Keys keys{{0x00080052, "STUDY"}, {0x00100010, "Müller^Änne"}, {0x0020000d, "1.2.3"}};
  for (const char* syntax : {"1.2.840.10008.1.2", "1.2.840.10008.1.2.1"}) {
    const Keys back = decodedKeys(encodedKeys(keys, syntax), syntax, {0x00100010, 0x0020000d, 0x00080060});
    EXPECT_EQ(back, (Keys{{0x00100010, "Müller^Änne"}, {0x0020000d, "1.2.3"}}));
  }
  EXPECT_EQ(shown("a\x1b[2Jb\xff\xc2\x9b \n", 64), "a[2Jb?");
  EXPECT_EQ(shown("ää", 3), "ä");
  EXPECT_THROW(decodedKeys(std::string(largestIdentifier + 1, '\0'), "1.2.840.10008.1.2", {}), NetworkError);
}

TEST(Receiver, RefusesWhatIsBeyondItsLimitsAndLeavesNothingOfIt) {
  const test::TemporaryFolder folder;
  writeObject(folder / "small", "1.2.3.1", 1000);
  writeObject(folder / "large", "1.2.3.2", 200000);
  writeObject(folder / "second", "1.2.3.3", 1000);
  ReceiveOptions o;
  o.port = freePort();
  o.folder = folder / "in";
  o.limits.objectBytes = 100000;
  o.limits.objects = 1;
  Running running(o);
  Node node;
  node.port = o.port;
  node.calledTitle = "GLISSON";
  node.timeout_s = 5;
  EXPECT_THROW(send(node, {folder / "large"}), NetworkError);
  EXPECT_EQ(send(node, {folder / "small"}).objects, 1u);
  EXPECT_EQ(send(node, {folder / "small"}).objects, 1u) << "what is there is answered with success";
  const Sent second = send(node, {folder / "second"});
  ASSERT_EQ(second.failed.size(), 1u);
  EXPECT_NE(second.failed.front().reason.find("out of resources"), std::string::npos) << second.failed.front().reason;
  EXPECT_EQ(filesIn(o.folder), 1u);
  EXPECT_TRUE(std::filesystem::exists(o.folder / fileNameFor("1.2.3.1")));
  const Received r = running.receiver.result();
  EXPECT_EQ(r.files.size(), 1u);
  EXPECT_EQ(r.alreadyThere, 1u);
}

/// A connection of which nothing has been said yet.
class Caller {
 public:
  explicit Caller(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in a{};
    a.sin_family = AF_INET;
    a.sin_port = htons(static_cast<std::uint16_t>(port));
    a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = connect(socket_, reinterpret_cast<sockaddr*>(&a), sizeof(a)) == 0;
  }
  ~Caller() { close(socket_); }
  Caller(const Caller&) = delete;
  Caller& operator=(const Caller&) = delete;
  bool connected() const { return connected_; }
  bool say(const std::string& bytes) const {
    return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }
  /// Whether the other side has closed the connection, waiting for it that long.
  bool isDropped(int within_s) const {
    const timeval time{within_s, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &time, sizeof(time));
    char byte = 0;
    const ssize_t n = recv(socket_, &byte, 1, 0);
    return n == 0 || (n < 0 && errno == ECONNRESET);
  }

 private:
  int socket_;
  bool connected_ = false;
};

TEST(Receiver, LetsOthersInWhileSomeAreSilentOrTrickle) {
  const test::TemporaryFolder folder;
  ReceiveOptions o;
  o.port = freePort();
  o.folder = folder / "in";
  Running running(o);
  const Caller silent(o.port), slow(o.port), foreign(o.port), endless(o.port);
  ASSERT_TRUE(silent.connected() && slow.connected() && foreign.connected() && endless.connected());
  ASSERT_TRUE(slow.say(std::string("\1\0\0\0\x40\0", 6)));
  ASSERT_TRUE(foreign.say("GET / HTTP/1.0\r\n\r\n"));
  ASSERT_TRUE(endless.say(std::string("\1\0\xff\xff\xff\xff", 6)));
  std::jthread trickle([&slow](const std::stop_token& stop) {
    while (!stop.stop_requested() && slow.say("x")) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  });
  Node node;
  node.port = o.port;
  node.calledTitle = "GLISSON";
  node.timeout_s = 10;
  EXPECT_LT(echo(node), 4.0) << "the wait for a request is 5 s";
  EXPECT_TRUE(foreign.isDropped(4)) << "what is no DICOM goes at once";
  EXPECT_TRUE(endless.isDropped(4)) << "no request is that long";
  EXPECT_TRUE(slow.isDropped(10)) << "the time is for the whole request";
  EXPECT_TRUE(silent.isDropped(10));
  EXPECT_LT(echo(node), 4.0);
}

TEST(Receiver, ListensWhereItIsTold) {
  const test::TemporaryFolder folder;
  ReceiveOptions o;
  o.port = freePort();
  o.folder = folder / "in";
  o.bind = "127.0.0.9";
  {
    Running running(o);
    EXPECT_FALSE(Caller(o.port).connected()) << "127.0.0.1 is another address";
    Node node;
    node.host = o.bind;
    node.port = o.port;
    node.calledTitle = "GLISSON";
    EXPECT_GT(echo(node), 0.0);
  }
  for (const char* address : {"", "localhost", "127.0.0", "192.0.2.1"}) {
    o.bind = address;
    EXPECT_THROW(Receiver{o}, NetworkError) << address;
  }
}

TEST(Receiver, StopsWhenCancelledAlthoughACallerIsSilent) {
  const test::TemporaryFolder folder;
  ReceiveOptions o;
  o.port = freePort();
  o.folder = folder / "in";
  {
    Running running(o);
    const Caller silent(o.port);
    ASSERT_TRUE(silent.connected());
    EXPECT_THROW(Receiver{o}, NetworkError) << "the port is taken";
  }
  EXPECT_EQ(filesIn(o.folder), 0u);
}

}  // namespace
}  // namespace glisson::pacs
