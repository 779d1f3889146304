// Stands in for affskel-server: takes the lock on its data directory, writes its arguments and its process id
// there, and accepts connections until it is told to end.
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <iostream>
#include <string>

int main(int argc, char** argv) {
  std::string data_dir, socket_path, all;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    all += argument + "\n";
    if (argument == "--data-dir" && i + 1 < argc) data_dir = argv[i + 1];
    if (argument == "--listen" && i + 1 < argc) socket_path = std::string(argv[i + 1]).substr(5);
  }
  const int lock = open((data_dir + "/lock").c_str(), O_RDWR | O_CREAT, 0600);
  if (flock(lock, LOCK_EX | LOCK_NB) != 0) {
    std::cerr << "the data directory is in use" << std::endl;
    return 4;
  }
  if (access((data_dir + "/full").c_str(), F_OK) == 0) {
    std::cerr << "database or disk is full" << std::endl;
    return 8;
  }
  if (access((data_dir + "/refuse").c_str(), F_OK) == 0) {
    std::cerr << "cannot open the database: it is refused" << std::endl;
    return 3;
  }
  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGTERM);
  sigprocmask(SIG_BLOCK, &ends, nullptr);
  std::ofstream(data_dir + "/arguments") << all << "session leader: " << (getsid(0) == getpid()) << "\n";
  std::ofstream(data_dir + "/pid.new") << getpid();
  rename((data_dir + "/pid.new").c_str(), (data_dir + "/pid").c_str());
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, socket_path.c_str(), sizeof address.sun_path - 1);
  unlink(socket_path.c_str());
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  if (bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 || listen(listener, 16) != 0)
    return 5;
  int signal_number = 0;
  sigwait(&ends, &signal_number);
  return 0;
}
