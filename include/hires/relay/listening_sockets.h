#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Who listens on which TCP port of this computer, as Linux tells it in /proc.
namespace hires::relay {

struct ListeningSocket {
  std::string address;  ///< as people write it: "127.0.0.1", "0.0.0.0", "::"
  int port{0};
  std::uint64_t inode{0};  ///< by which processes are found
  unsigned uid{0};         ///< user that owns it

  bool is_loopback() const;    ///< only programs on this computer can reach it
  bool is_everywhere() const;  ///< on all interfaces
};

/// The sockets in state LISTEN of /proc/net/tcp or /proc/net/tcp6, in their order.
/// @param where  for messages: "/proc/net/tcp".
/// @throws base::ConfigError naming the line that is none of that file's.
std::vector<ListeningSocket> ParseListeningSockets(const std::string& text,
                                                   const std::string& where);

/// The inode in "socket:[4711]", as links in `/proc/<pid>/fd` read; nothing for other files.
std::optional<std::uint64_t> SocketInodeOf(const std::string& link);

/// What can be seen of a process without asking it.
struct ProcessTraits {
  std::vector<std::string> words;       ///< command line
  std::string maps;                     ///< text of `/proc/<pid>/maps`
  std::vector<std::string> open_files;  ///< paths
};

/// Whether it is a ROS program: started by the names of ROS's own tools or with a node's arguments,
/// linked with roscpp, or writing a log below `log_folder` (as rospy does).
bool LooksLikeRos(const ProcessTraits& traits, const std::string& log_folder);

/// A process that holds a socket.
struct SocketOwner {
  int pid{0};
  std::string name;  ///< of its program, for scripts that of the script
  bool is_ros{false};
};

/// Owners of the given sockets by inode; processes of other users cannot be seen.
/// @param proc  "/proc", or a folder that looks like it.
std::map<std::uint64_t, SocketOwner> FindSocketOwners(const std::vector<ListeningSocket>& sockets,
                                                      const std::string& proc,
                                                      const std::string& log_folder);

}  // namespace hires::relay
