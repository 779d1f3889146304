#pragma once

#include "client/web/web_state.h"

namespace affskel::client {

// What answers the requests, by route; see web_service.cc.  All throw ClientError, which becomes the answer.

HttpResponse answer_session(WebCall& call);  ///< who is signed in, and what the page offers
HttpResponse begin_session(WebCall& call);   ///< by a key or a token
HttpResponse end_session(WebCall& call);
HttpResponse answer_server(WebCall& call);  ///< workers and queue

HttpResponse list_jobs(WebCall& call);
HttpResponse show_job(WebCall& call);
HttpResponse cancel_job(WebCall& call);
HttpResponse resume_job(WebCall& call);
HttpResponse delete_job(WebCall& call);
HttpResponse pin_job(WebCall& call);
HttpResponse unpin_job(WebCall& call);
HttpResponse list_events(WebCall& call);  ///< what happened to a job

HttpResponse take_mesh(WebCall& call);    ///< inspects an upload
HttpResponse lay_lattice(WebCall& call);  ///< points for a spacing, or a spacing for points
HttpResponse submit_mesh(WebCall& call);

HttpResponse make_result(WebCall& call);  ///< an artefact, a picture or the interactive page
HttpResponse send_result(WebCall& call);

}  // namespace affskel::client
