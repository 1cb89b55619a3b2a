// Times of a run, by name, and their medians.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace penumbra {

// Of an unsorted list; q = 0.5 is the median. 0 for an empty list.
inline double quantile(std::vector<double> values, double q)
{
    if (values.empty())
        return 0;
    const auto at = values.begin() +
                    static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

class RunStatistics {
public:
    void add(const std::string& name, double milliseconds)
    {
        m_times[name].push_back(milliseconds);
    }
    void add(const std::map<std::string, double>& milliseconds)
    {
        for (const auto& [name, ms] : milliseconds)
            add(name, ms);
    }
    [[nodiscard]] double at(const std::string& name, double q = 0.5) const
    {
        const auto found = m_times.find(name);
        return found == m_times.end() ? 0 : quantile(found->second, q);
    }
    [[nodiscard]] std::map<std::string, double> medians() const
    {
        std::map<std::string, double> out;
        for (const auto& [name, values] : m_times)
            out[name] = quantile(values, 0.5);
        return out;
    }

private:
    std::map<std::string, std::vector<double>> m_times;
};

} // namespace penumbra
