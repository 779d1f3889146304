// Loaded into servers and workers: calls on regular files fail, and the clock jumps, as the control page
// says.
//
// A jump of the real clock moves the deadlines of those that sleep by it.  Here the kernel's clock stands
// still, so deadlines made with the shifted clock are shifted back before they reach the kernel.
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "control.h"

namespace affskel::chaos {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
// A deadline later than this, in seconds, is one of the real-time clock: no machine has been up for so long.
constexpr time_t kSurelyRealTime = 1'000'000'000;

Control* page = nullptr;

__attribute__((constructor)) void map_control_page() {
  const char* path = std::getenv("AFFSKEL_CHAOS_CONTROL");
  if (path == nullptr) return;
  const int fd = static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CLOEXEC));
  if (fd < 0) return;
  void* mapped = mmap(nullptr, sizeof(Control), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (mapped != MAP_FAILED) page = static_cast<Control*>(mapped);
  syscall(SYS_close, fd);
}

template <class Function>
Function* next(const char* name, std::atomic<void*>& known) {
  void* found = known.load(std::memory_order_relaxed);
  if (found == nullptr) {
    found = dlsym(RTLD_NEXT, name);
    known.store(found, std::memory_order_relaxed);
  }
  return reinterpret_cast<Function*>(found);
}

bool told(std::uint32_t trouble) {
  return page != nullptr && (page->trouble.load(std::memory_order_relaxed) & trouble) != 0;
}

void bite() {
  page->bites.fetch_add(1, std::memory_order_relaxed);
}

bool is_file(int fd) {
  struct stat facts {};
  return fd > 2 && fstat(fd, &facts) == 0 && S_ISREG(facts.st_mode);
}

/// The error that changing a file must answer, or 0.
int change_error(std::uint32_t also) {
  if (told(kReadOnly)) return EROFS;
  if (told(kNoSpace)) return ENOSPC;
  if (told(also & kWriteError)) return EIO;
  return 0;
}

template <class Result>
Result failed(int error) {
  bite();
  errno = error;
  return Result{-1};
}

std::int64_t shift() {
  return page == nullptr ? 0 : page->clock_shift_ns.load(std::memory_order_relaxed);
}

timespec moved(const timespec& time, std::int64_t by) {
  const std::int64_t nanoseconds = time.tv_nsec + by % kSecond;
  const std::int64_t carry = nanoseconds < 0 ? -1 : nanoseconds / kSecond;
  return {static_cast<time_t>(time.tv_sec + by / kSecond + carry),
          static_cast<long>(nanoseconds - carry * kSecond)};
}

/// A deadline as the kernel's clock counts.
const timespec* kernels(const timespec* deadline, timespec& store) {
  if (deadline == nullptr || shift() == 0 || deadline->tv_sec < kSurelyRealTime) return deadline;
  store = moved(*deadline, -shift());
  return &store;
}

/// What of a write is let through: all, half, or an error as a negative number.
ssize_t allowed(int fd, size_t bytes) {
  if (page == nullptr || page->trouble.load(std::memory_order_relaxed) == 0 || !is_file(fd)) {
    return static_cast<ssize_t>(bytes);
  }
  const int error = change_error(kWriteError);
  if (error != 0) return failed<ssize_t>(error);
  if (!told(kShortWrites) || bytes < 2) return static_cast<ssize_t>(bytes);
  bite();
  return static_cast<ssize_t>(bytes / 2);
}

bool opens_for_change(int flags) {
  return (flags & O_ACCMODE) != O_RDONLY || (flags & (O_CREAT | O_TRUNC)) != 0;
}

}  // namespace
}  // namespace affskel::chaos

using namespace affskel::chaos;

// NOLINTBEGIN: names and signatures are the C library's.
#define NEXT(name)                        \
  static std::atomic<void*> known_##name; \
  const auto real = next<decltype(::name)>(#name, known_##name)

extern "C" {

ssize_t write(int fd, const void* data, size_t bytes) {
  NEXT(write);
  const ssize_t part = allowed(fd, bytes);
  return part < 0 ? -1 : real(fd, data, static_cast<size_t>(part));
}

ssize_t pwrite(int fd, const void* data, size_t bytes, off_t at) {
  NEXT(pwrite);
  const ssize_t part = allowed(fd, bytes);
  return part < 0 ? -1 : real(fd, data, static_cast<size_t>(part), at);
}

ssize_t pwrite64(int fd, const void* data, size_t bytes, off64_t at) {
  NEXT(pwrite64);
  const ssize_t part = allowed(fd, bytes);
  return part < 0 ? -1 : real(fd, data, static_cast<size_t>(part), at);
}

ssize_t read(int fd, void* data, size_t bytes) {
  NEXT(read);
  return told(kReadError) && is_file(fd) ? failed<ssize_t>(EIO) : real(fd, data, bytes);
}

ssize_t pread(int fd, void* data, size_t bytes, off_t at) {
  NEXT(pread);
  return told(kReadError) && is_file(fd) ? failed<ssize_t>(EIO) : real(fd, data, bytes, at);
}

ssize_t pread64(int fd, void* data, size_t bytes, off64_t at) {
  NEXT(pread64);
  return told(kReadError) && is_file(fd) ? failed<ssize_t>(EIO) : real(fd, data, bytes, at);
}

int fsync(int fd) {
  NEXT(fsync);
  return told(kSyncError) ? failed<int>(EIO) : real(fd);
}

int fdatasync(int fd) {
  NEXT(fdatasync);
  return told(kSyncError) ? failed<int>(EIO) : real(fd);
}

int ftruncate(int fd, off_t length) noexcept {
  NEXT(ftruncate);
  return told(kReadOnly) ? failed<int>(EROFS) : real(fd, length);
}

int ftruncate64(int fd, off64_t length) noexcept {
  NEXT(ftruncate64);
  return told(kReadOnly) ? failed<int>(EROFS) : real(fd, length);
}

int posix_fallocate(int fd, off_t offset, off_t length) {
  NEXT(posix_fallocate);
  const int error = change_error(0);
  if (error == 0) return real(fd, offset, length);
  bite();
  return error;
}

// A full disk says that it is full.
int statvfs(const char* path, struct statvfs* facts) noexcept {
  static std::atomic<void*> known;
  const auto real = next<int(const char*, struct statvfs*)>("statvfs", known);
  const int result = real(path, facts);
  if (result == 0 && told(kNoSpace)) facts->f_bavail = facts->f_bfree = 0;
  return result;
}

int statvfs64(const char* path, struct statvfs64* facts) noexcept {
  static std::atomic<void*> known;
  const auto real = next<int(const char*, struct statvfs64*)>("statvfs64", known);
  const int result = real(path, facts);
  if (result == 0 && told(kNoSpace)) facts->f_bavail = facts->f_bfree = 0;
  return result;
}

int unlink(const char* path) noexcept {
  NEXT(unlink);
  return told(kReadOnly) ? failed<int>(EROFS) : real(path);
}

int rename(const char* from, const char* to) noexcept {
  NEXT(rename);
  return told(kReadOnly) ? failed<int>(EROFS) : real(from, to);
}

int open(const char* path, int flags, ...) {
  NEXT(open);
  std::va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return told(kReadOnly) && opens_for_change(flags) ? failed<int>(EROFS) : real(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  NEXT(open64);
  std::va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return told(kReadOnly) && opens_for_change(flags) ? failed<int>(EROFS) : real(path, flags, mode);
}

int clock_gettime(clockid_t clock, timespec* now) noexcept {
  NEXT(clock_gettime);
  const int result = real(clock, now);
  const std::int64_t by = clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE ? shift() : 0;
  if (result != 0 || by == 0) return result;
  *now = moved(*now, by);
  bite();
  return 0;
}

int gettimeofday(timeval* now, void*) noexcept {
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  now->tv_sec = time.tv_sec;
  now->tv_usec = time.tv_nsec / 1000;
  return 0;
}

time_t time(time_t* out) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (out != nullptr) *out = now.tv_sec;
  return now.tv_sec;
}

int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* deadline) {
  NEXT(pthread_cond_timedwait);
  timespec store{};
  return real(condition, mutex, kernels(deadline, store));
}

int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                           const timespec* deadline) {
  NEXT(pthread_cond_clockwait);
  timespec store{};
  return real(condition, mutex, clock, kernels(deadline, store));
}

// Abseil sleeps by futexes of its own.
long syscall(long number, ...) noexcept {
  static std::atomic<void*> known;
  const auto real = next<long(long, long, long, long, long, long, long)>("syscall", known);
  std::va_list rest;
  va_start(rest, number);
  long a[6];
  for (long& argument : a) argument = va_arg(rest, long);
  va_end(rest);
  timespec store{};
  if (number == SYS_futex && (a[1] & FUTEX_CLOCK_REALTIME) != 0 && a[3] != 0) {
    a[3] = reinterpret_cast<long>(kernels(reinterpret_cast<const timespec*>(a[3]), store));
  }
  return real(number, a[0], a[1], a[2], a[3], a[4], a[5]);
}

}  // extern "C"
// NOLINTEND
