// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/chromium.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace stereod {
namespace {

constexpr int kTimeout_ms = 60'000;

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n') {
      result += "\\n";
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string from_base64(std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) break;
    bits = bits << 6 | static_cast<unsigned>(digit);
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 0xFF);
  }
  return bytes;
}

// Returns the JSON string of member `name` in the answer, unescaped by the YAML parser: JSON is YAML.
std::string member(const std::string& answer, const std::string& name) {
  const std::size_t at = answer.find("\"" + name + "\":\"");
  if (at == std::string::npos) throw std::runtime_error("Chromium answered " + answer.substr(0, 1000));
  std::size_t end = at + name.size() + 4;
  while (answer[end] != '"') end += answer[end] == '\\' ? 2 : 1;
  const std::size_t begin = at + name.size() + 3;
  return YAML::Load(answer.substr(begin, end + 1 - begin)).as<std::string>();
}

}  // namespace

std::optional<std::filesystem::path> Chromium::program() {
  for (const char* name : {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"}) {
    if (access(name, X_OK) == 0) return name;
  }
  return std::nullopt;
}

Chromium::Chromium(const std::filesystem::path& program, const std::filesystem::path& scratch) {
  int commands[2], answers[2];
  if (pipe2(commands, O_CLOEXEC) != 0 || pipe2(answers, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  // Chromium expects descriptors 3 and 4. Higher numbers for the ends keep dup2 from overwriting them.
  const int reads = fcntl(commands[0], F_DUPFD_CLOEXEC, 10), writes = fcntl(answers[1], F_DUPFD_CLOEXEC, 10);
  close(commands[0]);
  close(answers[1]);
  to_ = commands[1];
  from_ = answers[0];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, reads, 3);
  posix_spawn_file_actions_adddup2(&actions, writes, 4);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  std::vector<std::string> words = {program.string(),
                                    "--headless=new",
                                    "--no-sandbox",
                                    "--disable-dev-shm-usage",
                                    "--disable-gpu-sandbox",
                                    "--use-angle=swiftshader",
                                    "--enable-unsafe-swiftshader",
                                    "--no-first-run",
                                    "--disable-background-networking",
                                    "--disable-component-update",
                                    "--user-data-dir=" + (scratch / "chromium").string(),
                                    "--remote-debugging-pipe"};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP);  // a process group, so that its children are ended too
  const int error = posix_spawn(&child_, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(reads);
  close(writes);
  if (error != 0) throw std::runtime_error("Chromium cannot be started");
}

Chromium::~Chromium() {
  close(to_);
  close(from_);
  kill(-child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

std::string Chromium::read_message() {
  while (true) {
    const std::size_t end = buffer_.find('\0');
    if (end != std::string::npos) {
      std::string message = buffer_.substr(0, end);
      buffer_.erase(0, end + 1);
      return message;
    }
    pollfd waiting{from_, POLLIN, 0};
    std::array<char, 65536> bytes{};
    const ssize_t got = poll(&waiting, 1, kTimeout_ms) == 1 ? read(from_, bytes.data(), bytes.size()) : 0;
    if (got <= 0) throw std::runtime_error("Chromium does not answer");
    buffer_.append(bytes.data(), static_cast<std::size_t>(got));
  }
}

std::string Chromium::call(const std::string& method, const std::string& parameters) {
  const std::string id = "\"id\":" + std::to_string(++last_id_);
  std::string message = "{" + id + ",\"method\":\"" + method + "\",\"params\":{" + parameters + "}";
  if (!session_.empty()) message += ",\"sessionId\":\"" + session_ + "\"";
  message += "}";
  if (write(to_, message.c_str(), message.size() + 1) != static_cast<ssize_t>(message.size() + 1)) {
    throw std::runtime_error("Chromium closed its pipe");
  }
  while (true) {
    std::string answer = read_message();
    if (answer.rfind("{" + id + ",", 0) == 0) return answer;
  }
}

void Chromium::open(const std::string& url, int width, int height) {
  const std::string target = member(call("Target.createTarget", "\"url\":\"about:blank\""), "targetId");
  session_ =
      member(call("Target.attachToTarget", "\"targetId\":\"" + target + "\",\"flatten\":true"), "sessionId");
  call("Emulation.setDeviceMetricsOverride", "\"width\":" + std::to_string(width) +
                                                 ",\"height\":" + std::to_string(height) +
                                                 ",\"deviceScaleFactor\":1,\"mobile\":false");
  call("Page.navigate", "\"url\":" + quoted(url));
}

std::string Chromium::evaluate(const std::string& expression) {
  return member(call("Runtime.evaluate", "\"returnByValue\":true,\"awaitPromise\":true,\"expression\":" +
                                             quoted("(async () => String(await (" + expression + ")))()")),
                "value");
}

void Chromium::screenshot(const std::filesystem::path& file) {
  const std::string answer = call("Page.captureScreenshot", "\"format\":\"png\"");
  const std::string png = from_base64(member(answer, "data"));
  std::ofstream(file, std::ios::binary) << png;
}

}  // namespace stereod
