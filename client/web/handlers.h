#pragma once

#include "client/web/web_state.h"

namespace affskel::client {

// What answers the requests, by route; see web_service.cc.  All throw ClientError, which becomes the answer.

http::Response answer_session(WebCall& call);  ///< the user, and what the page offers
http::Response begin_session(WebCall& call);   ///< by a key or a token
http::Response end_session(WebCall& call);
http::Response answer_server(WebCall& call);  ///< workers and queue

http::Response list_jobs(WebCall& call);
http::Response show_job(WebCall& call);
http::Response cancel_job(WebCall& call);
http::Response resume_job(WebCall& call);
http::Response delete_job(WebCall& call);
http::Response pin_job(WebCall& call);
http::Response unpin_job(WebCall& call);
http::Response set_stance(WebCall& call);
http::Response list_events(WebCall& call);  ///< what happened to a job

http::Response take_mesh(WebCall& call);
http::Response turn_mesh(WebCall& call);    ///< inspects an upload
http::Response lay_lattice(WebCall& call);  ///< points for a spacing, or a spacing for points
http::Response submit_mesh(WebCall& call);

http::Response make_result(WebCall& call);
http::Response make_archive(WebCall& call);  ///< an artefact, a picture or the interactive page
http::Response send_result(WebCall& call);
http::Response send_thumbnail(WebCall& call);  ///< a small picture of a done job

}  // namespace affskel::client
