// One of our programs while it runs: to be killed, interrupted, or run beside another.
#pragma once

#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <vector>

extern char** environ;

namespace penumbra {

class BackgroundProgram {
public:
    // Output and errors go to the file `log`.
    BackgroundProgram(std::string program, std::vector<std::string> arguments,
                      const std::filesystem::path& log)
    {
        std::vector<char*> argv = {program.data()};
        for (std::string& argument : arguments)
            argv.push_back(argument.data());
        argv.push_back(nullptr);
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_addopen(&files, 1, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                         0644);
        posix_spawn_file_actions_adddup2(&files, 1, 2);
        if (::posix_spawn(&m_process, program.c_str(), &files, nullptr, argv.data(), environ) != 0)
            m_process = -1;
        posix_spawn_file_actions_destroy(&files);
    }
    BackgroundProgram(const BackgroundProgram&) = delete;
    BackgroundProgram& operator=(const BackgroundProgram&) = delete;
    ~BackgroundProgram()
    {
        signal(SIGKILL);
        wait();
    }

    void signal(int number) const
    {
        if (m_process > 0)
            ::kill(m_process, number);
    }

    // Exit code, or minus the signal that ended it.
    int wait()
    {
        if (m_process > 0) {
            int status = 0;
            ::waitpid(m_process, &status, 0);
            m_process = -1;
            m_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        }
        return m_code;
    }

private:
    pid_t m_process = -1;
    int m_code = -1;
};

// False after a minute in vain.
template <class Condition>
bool waitUntil(Condition condition)
{
    for (int i = 0; i < 6000; ++i) {
        if (condition())
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

} // namespace penumbra
