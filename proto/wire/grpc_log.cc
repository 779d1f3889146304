#include "wire/grpc_log.h"

#include <google/protobuf/stubs/logging.h>
#include <grpc/support/log.h>

#include <atomic>

#include "base/logfmt.h"

namespace affskel::wire {
namespace {

std::atomic<GrpcLog::Sink> current = nullptr;

void pass_on(gpr_log_func_args* entry) {
  const GrpcLog::Sink sink = current;
  if (sink == nullptr) return;
  sink(entry->severity == GPR_LOG_SEVERITY_ERROR,
       base::logfmt("grpc", {{"file", entry->file}, {"line", entry->line}, {"message", entry->message}}));
}

}  // namespace

GrpcLog::GrpcLog(Sink sink) {
  current = sink;
  gpr_set_log_function(pass_on);
  google::protobuf::SetLogHandler(nullptr);
}

GrpcLog::~GrpcLog() {
  gpr_set_log_function(nullptr);  // as it was
  current = nullptr;
}

}  // namespace affskel::wire
