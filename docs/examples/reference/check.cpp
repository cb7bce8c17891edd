// g++ -std=c++17 check.cpp -o check && ./check tables/contact.csv mine.csv [tolerance]
// Exit 0 if mine agrees with the reference table; else says how it does not.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>
using Row = std::vector<std::string>;

std::string text(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
std::vector<Row> rows(const std::string& all) {
    std::vector<Row> found;
    std::istringstream lines(all);
    for (std::string line, cell; std::getline(lines, line);) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        std::istringstream cells(line);
        found.emplace_back();
        while (std::getline(cells, cell, ',')) found.back().push_back(cell);
    }
    return found;
}
bool numeric(const std::string& s) { char* end; std::strtod(s.c_str(), &end); return !s.empty() && !*end; }
int stale(const std::string& what) { std::cout << what << ": stale\n"; return 1; }

int main(int count, char** words) {
    if (count < 3) return 2;
    const std::string path = words[1], ours_text = text(path);
    const double tolerance = count > 3 ? std::atof(words[3]) : 1e-6;
    std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a, as the column fnv1a of MANIFEST.csv
    for (unsigned char c : ours_text) hash = (hash ^ c) * 0x100000001b3u;
    char sum[17];
    std::snprintf(sum, sizeof sum, "%016llx", static_cast<unsigned long long>(hash));
    const auto slash = path.find_last_of('/') + 1;
    bool known = false;
    for (const Row& line : rows(text(path.substr(0, slash) + "MANIFEST.csv")))
        known |= line.size() > 4 && line[0] == path.substr(slash) && line[4] == sum;
    const auto ours = rows(ours_text), mine = rows(text(words[2]));
    if (!known) return stale(path);
    if (ours.size() != mine.size() || ours[0] != mine[0]) return stale(words[2]);
    int wrong = 0;
    for (std::size_t j = 0; j < ours[0].size(); ++j) {
        double size = 0, worst = 0, apart = 0;
        std::vector<double> factors;
        for (std::size_t i = 1; i < ours.size(); ++i)
            if (!numeric(ours[i][j])) { if (ours[i][j] != mine[i].at(j)) return stale(words[2]); }
            else if (const double a = std::atof(ours[i][j].c_str()); a == a) size = std::max(size, std::abs(a));
        for (std::size_t i = 1; i < ours.size(); ++i) {
            if (!numeric(ours[i][j])) continue;
            const double a = std::atof(ours[i][j].c_str()), b = std::atof(mine[i].at(j).c_str());
            if (a != a) continue;
            worst = std::max(worst, b == b ? std::abs(a - b) : INFINITY);
            if (std::abs(a) > 1e-3 * size) factors.push_back(b / a);
        }
        if (factors.empty() || worst <= tolerance * size) continue;
        std::nth_element(factors.begin(), factors.begin() + factors.size() / 2, factors.end());
        const double factor = factors[factors.size() / 2];
        for (std::size_t i = 1; i < ours.size(); ++i)
            if (const double a = std::atof(ours[i][j].c_str()); numeric(ours[i][j]) && a == a)
                apart = std::max(apart, std::abs(std::atof(mine[i][j].c_str()) / factor - a) / size);
        const double near = std::max(tolerance, 1e-3);
        const bool alike = apart <= near, sign = std::abs(factor + 1) <= near;
        std::cout << ours[0][j] << (alike ? sign ? ": wrong sign" : ": wrong unit" : ": off by ");
        if (!alike) std::cout << worst / size;
        else if (!sign) std::cout << ", " << factor << " times";
        std::cout << "\n", wrong = 1;
    }
    if (!wrong) std::cout << "agrees\n";
    return wrong;
}
