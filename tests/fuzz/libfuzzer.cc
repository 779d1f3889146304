// libFuzzer's way in; which target is said by the name of the program: affskel_fuzz_TARGET.
#include <google/protobuf/stubs/logging.h>

#include <cstdint>
#include <filesystem>

#include "targets.h"

namespace {
const affskel::fuzz::Target* target = nullptr;
}

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** argv) {
  google::protobuf::SetLogHandler(nullptr);  // of every string that is no UTF-8
  const std::string program = std::filesystem::path((*argv)[0]).filename().string();
  target = &affskel::fuzz::target_named(program.substr(std::string("affskel_fuzz_").size()));
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  target->run({reinterpret_cast<const char*>(data), size});
  return 0;
}
