// SPDX-License-Identifier: GPL-3.0-or-later
#include "cohort/processes.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include "base/error.h"

namespace glisson::cohort {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t outputLimit = std::size_t(64) << 20;

std::string lastLine(const std::string& text) {
  std::istringstream in(text);
  std::string line, last;
  while (std::getline(in, line))
    if (!line.empty()) last = line;
  return last;
}

/// A running child with the reading ends of its standard output and error.
class Child {
 public:
  Child(const std::filesystem::path& executable, const Job& job, std::size_t index_) : index(index_) {
    std::vector<std::string> words = {executable.string()};
    words.insert(words.end(), job.arguments.begin(), job.arguments.end());
    std::vector<char*> argv;
    for (std::string& w : words) argv.push_back(w.data());
    argv.push_back(nullptr);
    std::array<int, 2> out{}, err{};
    if (pipe2(out.data(), O_CLOEXEC) != 0 || pipe2(err.data(), O_CLOEXEC) != 0)
      throw BadInput(std::string("cannot start another process: ") + std::strerror(errno));
    const pid_t parent = getpid();
    pid = fork();
    if (pid == 0) {
      // Between fork and exec only calls that are safe there.
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) _exit(127);
      dup2(out[1], STDOUT_FILENO);
      dup2(err[1], STDERR_FILENO);
      const int nothing = open("/dev/null", O_RDONLY);
      if (nothing >= 0) dup2(nothing, STDIN_FILENO);
      execv(argv[0], argv.data());
      _exit(127);
    }
    close(out[1]);
    close(err[1]);
    for (const int end : {out[0], err[0]}) fcntl(end, F_SETFL, O_NONBLOCK);
    ends = {out[0], err[0]};
    if (pid < 0) {
      closeEnds();
      throw BadInput(std::string("cannot start another process: ") + std::strerror(errno));
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    closeEnds();
    if (pid > 0) {
      kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
    }
  }

  /// Takes what has been written; false once both ends are closed.
  bool read() {
    for (std::size_t e = 0; e < 2; ++e) {
      if (ends[e] < 0) continue;
      std::array<char, 65536> buffer{};
      const ssize_t n = ::read(ends[e], buffer.data(), buffer.size());
      if (n > 0 && text[e].size() < outputLimit) text[e].append(buffer.data(), static_cast<std::size_t>(n));
      if (n == 0 || (n < 0 && errno != EINTR && errno != EAGAIN)) close(std::exchange(ends[e], -1));
    }
    return ends[0] >= 0 || ends[1] >= 0;
  }

  JobOutcome wait() {
    int status = 0;
    rusage usage{};
    wait4(pid, &status, 0, &usage);
    pid = -1;
    JobOutcome o;
    if (WIFEXITED(status)) o.exitCode = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) o.signal = WTERMSIG(status);
    o.standardOutput = std::move(text[0]);
    o.message = lastLine(text[1]);
    o.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    o.peak_MB = static_cast<double>(usage.ru_maxrss) / 1024.0;
    return o;
  }

  std::size_t index;
  pid_t pid = -1;
  std::array<int, 2> ends = {-1, -1};  ///< standard output and error
  std::array<std::string, 2> text;
  Clock::time_point start = Clock::now();

 private:
  void closeEnds() {
    for (int& e : ends)
      if (e >= 0) close(std::exchange(e, -1));
  }
};

using Children = std::vector<std::unique_ptr<Child>>;

/// Asks all children to end; the destructor kills those that have not within a second.
void stop(Children& children) {
  for (const auto& c : children) kill(c->pid, SIGTERM);
  const auto until = Clock::now() + std::chrono::seconds(1);
  for (const auto& c : children)
    while (Clock::now() < until && c->pid > 0) {
      if (waitpid(c->pid, nullptr, WNOHANG) != 0)
        c->pid = -1;
      else
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  children.clear();
}

std::string timeLeft(Clock::time_point start, std::size_t done, std::size_t all) {
  if (done == 0) return {};
  const double each = std::chrono::duration<double>(Clock::now() - start).count() / static_cast<double>(done);
  const auto seconds = static_cast<long>(each * static_cast<double>(all - done));
  if (seconds < 90) return ", about " + std::to_string(seconds) + " s left";
  return ", about " + std::to_string((seconds + 30) / 60) + " min left";
}

}  // namespace

void runJobs(const std::filesystem::path& executable, const std::vector<Job>& jobs, int parallel,
             const std::function<void(std::size_t, const JobOutcome&)>& done, const Progress& progress) {
  if (access(executable.c_str(), X_OK) != 0)
    throw BadInput("'" + executable.filename().string() + "' cannot be run; is the installation complete?");
  Children running;
  std::size_t next = 0, finished = 0;
  const auto start = Clock::now();
  while (finished < jobs.size()) {
    while (next < jobs.size() && running.size() < static_cast<std::size_t>(std::max(1, parallel))) {
      running.push_back(std::make_unique<Child>(executable, jobs[next], next));
      ++next;
    }
    try {
      progress.check();
    } catch (const Cancelled&) {
      stop(running);
      throw;
    }
    std::vector<pollfd> waiting;
    for (const auto& c : running)
      for (const int end : c->ends)
        if (end >= 0) waiting.push_back({end, POLLIN, 0});
    poll(waiting.data(), waiting.size(), 100);
    for (std::size_t i = 0; i < running.size();) {
      Child& c = *running[i];
      bool open = true;
      for (const pollfd& p : waiting)
        if (p.revents != 0 && (p.fd == c.ends[0] || p.fd == c.ends[1])) open = c.read() && open;
      if (open && (c.ends[0] >= 0 || c.ends[1] >= 0)) {
        ++i;
        continue;
      }
      const std::size_t index = c.index;
      const JobOutcome outcome = c.wait();
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
      ++finished;
      done(index, outcome);
      progress.report(static_cast<double>(finished) / static_cast<double>(jobs.size()),
                      jobs[index].name + ": " + std::to_string(finished) + " of " + std::to_string(jobs.size()) +
                          timeLeft(start, finished, jobs.size()));
    }
  }
}

int threadsEach(int parallel) {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / std::max(1, parallel));
}

int jobsThatFit(double peak_MB) {
  int jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::ifstream in("/proc/meminfo");
  std::string key;
  double kB = 0.0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    if (words >> key >> kB && key == "MemAvailable:" && peak_MB > 0.0)
      jobs = std::clamp(static_cast<int>(0.8 * kB / 1024.0 / peak_MB), 1, jobs);
  }
  return jobs;
}

}  // namespace glisson::cohort
