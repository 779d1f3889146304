#include "forked.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

namespace affskel::bench {
namespace {

// The pipe carries one letter and a text.
constexpr char kResult = 'R';
constexpr char kError = 'E';

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

void write_all(int fd, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = write(fd, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return;  // the reader has gone
    done += static_cast<std::size_t>(n);
  }
}

std::string read_all(int fd) {
  std::string text;
  char buffer[4096];
  for (;;) {
    const ssize_t n = read(fd, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(n));
  }
}

std::string outcome(const std::function<std::string()>& work) {
  try {
    return kResult + work();
  } catch (const std::bad_alloc&) {
    return std::string(1, kError) + "not enough memory";
  } catch (const std::exception& error) {
    return kError + std::string(error.what());
  }
}

[[noreturn]] void be_child(int fd, const std::function<std::string()>& work, std::uint64_t memory_limit) {
  if (memory_limit > 0) {
    const rlimit limit{memory_limit, memory_limit};
    setrlimit(RLIMIT_AS, &limit);
  }
  write_all(fd, outcome(work));
  // No destructors or buffers of the parent's: they are the parent's to run and to flush.
  _exit(0);
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) fail("waitpid");
  }
  return status;
}

}  // namespace

std::string run_forked(const std::function<std::string()>& work, std::uint64_t memory_limit) {
  int ends[2];
  if (pipe(ends) != 0) fail("pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child == 0) {
    close(ends[0]);
    be_child(ends[1], work, memory_limit);
  }
  close(ends[1]);
  const std::string text = read_all(ends[0]);
  close(ends[0]);
  const int status = wait_for(child);
  if (WIFSIGNALED(status)) {
    throw std::runtime_error("killed by signal " + std::to_string(WTERMSIG(status)));
  }
  if (text.empty()) throw std::runtime_error("the process ended without a result");
  if (text[0] == kError) throw std::runtime_error(text.substr(1));
  return text.substr(1);
}

}  // namespace affskel::bench
