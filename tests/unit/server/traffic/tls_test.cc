#include "traffic/tls.h"

#include <filesystem>

#include "access_fixture.h"
#include "tools/files.h"
#include "tools/test_authority.h"

namespace affskel::server {
namespace {

/// A server with tokens whose TCP address speaks TLS.
class TlsTest : public AccessTest {
 protected:
  TlsTest() : authority_(directory_.path(), "authority"), stranger_(directory_.path(), "stranger") {
    authority_.sign("server");
    authority_.sign("client");
    options_.tls.certificate = authority_.certificate("server");
    options_.tls.key = authority_.key("server");
  }
  wire::AccessFiles trusting(const tests::TestAuthority& authority, const std::string& own = "") const {
    wire::AccessFiles files;
    files.tls_ca = authority.file();
    if (!own.empty()) {
      files.tls_cert = authority_.certificate(own);
      files.tls_key = authority_.key(own);
    }
    return files;
  }
  grpc::Status call(const wire::AccessFiles& files, const std::string& owner = "") {
    v1::ServerInfo response;
    return info(*v1::ErosionService::NewStub(tcp(owner, files)), &response);
  }

  tests::TestAuthority authority_;
  tests::TestAuthority stranger_;
};

TEST_F(TlsTest, OnlyWithTlsAndATrustedServer) {
  start();
  add("ada", v1::ROLE_USER);
  EXPECT_TRUE(call(trusting(authority_), "ada").ok());
  EXPECT_EQ(call(trusting(authority_)).error_code(), grpc::UNAUTHENTICATED);
  EXPECT_EQ(call(trusting(stranger_), "ada").error_code(), grpc::UNAVAILABLE);
  EXPECT_EQ(call({}, "ada").error_code(), grpc::UNAVAILABLE) << "in the clear";
  v1::ServerInfo response;
  EXPECT_TRUE(info(*client_, &response).ok()) << "the Unix socket needs none";
}

TEST_F(TlsTest, OnlyOfTheNameThatIsCalled) {
  start();
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  arguments.SetSslTargetNameOverride("lab.example.org");
  const auto channel = wire::make_channel(server_->addresses().back(), trusting(authority_), arguments);
  v1::ServerInfo response;
  EXPECT_EQ(info(*v1::ErosionService::NewStub(channel), &response).error_code(), grpc::UNAVAILABLE);
}

TEST_F(TlsTest, ConnectionsAreInTheTableAsOthersAre) {
  start();
  const std::string job = submit("OFF 1");
  add("ada", v1::ROLE_ADMIN);
  const std::size_t others = server_->room().connections.size();
  const auto stub = v1::ErosionService::NewStub(tcp("ada", trusting(authority_)));
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_job(job);
  const auto reader = stub->WatchJob(&context, request);
  v1::Job seen;
  ASSERT_TRUE(reader->Read(&seen));
  EXPECT_EQ(server_->room().connections.size(), others + 1);
  // Only a connection that is found in the table has its calls counted there.
  while (server_->room().connections.calls() != 1) std::this_thread::yield();
  context.TryCancel();
  reader->Finish();
}

TEST_F(TlsTest, ClientCertificatesAreAskedForAndVerified) {
  options_.tls.client_ca = authority_.file();
  start();
  add("ada", v1::ROLE_USER);
  EXPECT_TRUE(call(trusting(authority_, "client"), "ada").ok());
  const grpc::Status without = call(trusting(authority_), "ada");
  EXPECT_EQ(without.error_code(), grpc::UNAUTHENTICATED);
  EXPECT_EQ(without.error_message(), "this server asks for a client certificate");
  stranger_.sign("strange");
  EXPECT_EQ(call(trusting(authority_, "strange"), "ada").error_code(), grpc::UNAVAILABLE);
  EXPECT_EQ(call(trusting(authority_, "client")).error_code(), grpc::UNAUTHENTICATED)
      << "a token all the same";
}

TEST_F(TlsTest, ReplacedCertificatesAreUsedWithoutARestart) {
  start();
  ASSERT_TRUE(call(trusting(authority_)).ok());
  stranger_.sign("server");
  while (!call(trusting(stranger_)).ok()) std::this_thread::yield();
  EXPECT_EQ(call(trusting(authority_)).error_code(), grpc::UNAVAILABLE);
}

TEST_F(TlsTest, ClientsTakeReplacedFilesWithoutARestart) {
  options_.tls.client_ca = authority_.file();
  start();
  add("ada", v1::ROLE_USER);
  stranger_.sign("own");
  wire::AccessFiles files = trusting(stranger_, "own");
  files.tls_ca = file("ca.pem");
  spit("ca.pem", tests::read_file(stranger_.file()));
  const auto stub = v1::ErosionService::NewStub(tcp("ada", files));
  v1::ServerInfo response;
  ASSERT_EQ(info(*stub, &response).error_code(), grpc::UNAVAILABLE);
  spit("ca.pem", tests::read_file(stranger_.file()) + tests::read_file(authority_.file()));
  authority_.sign("own");
  while (!info(*stub, &response).ok()) std::this_thread::yield();
}

TEST_F(TlsTest, FilesThatAreNoGoodAreNamed) {
  spit("rubbish.pem", "rubbish");
  const auto error_with = [&](const net::TlsOptions& tls) {
    options_.tls = tls;
    try {
      start();
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const net::TlsOptions good = options_.tls;
  for (std::string net::TlsOptions::*member :
       {&net::TlsOptions::certificate, &net::TlsOptions::key, &net::TlsOptions::client_ca}) {
    net::TlsOptions bad = good;
    bad.*member = file("rubbish.pem");
    EXPECT_NE(error_with(bad).find(file("rubbish.pem")), std::string::npos) << error_with(bad);
  }
}

}  // namespace
}  // namespace affskel::server
