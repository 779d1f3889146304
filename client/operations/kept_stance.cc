#include "client/operations/kept_stance.h"

namespace affskel::client {

core::Stance keep_stance(Session& session, const v1::Job& job, const StanceChoice& choice,
                         const core::Mesh& mesh) {
  const core::Stance stance = stance_of(choice, job, mesh);
  if (choice.up) {
    session.set_stance(job.id(), stance_message(stance));
  } else if (choice.by_shape) {
    session.set_stance(job.id(), {});
  }
  return stance;
}

}  // namespace affskel::client
