// SPDX-License-Identifier: MIT
// Poisson-disk samples: how many, where, and how far apart. The measure of distance is that of the
// hexagonal lattice with as many points per area: no set of many points has a larger least
// distance.
#include "host/scene/poisson_disk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "host/scene/light.h"

namespace penumbra::tests {
namespace {

using Points = std::vector<glm::dvec2>;

double leastDistance(const Points& points) {
    double least = 1e300;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            least = std::min(least, glm::distance(points[i], points[k]));
    return least;
}

double latticeDistance(int count, bool disk) {
    const double area = disk ? M_PI : 4;
    return std::sqrt(2 / std::sqrt(3.0) * area / count);
}

bool inside(const glm::dvec2& p, bool disk) {
    return disk ? glm::dot(p, p) <= 1 : std::abs(p.x) <= 1 && std::abs(p.y) <= 1;
}

Points randomPoints(int count, bool disk, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-1, 1);
    Points points;
    while (static_cast<int>(points.size()) < count) {
        const glm::dvec2 p{place(random), place(random)};
        if (inside(p, disk)) points.push_back(p);
    }
    return points;
}

/// Mitchell: each next point is the farthest of ten random ones per point there is.
Points bestCandidates(int count, bool disk, unsigned seed) {
    std::mt19937 random(seed);
    Points points = randomPoints(1, disk, seed);
    while (static_cast<int>(points.size()) < count) {
        glm::dvec2 best(0);
        double farthest = -1;
        const auto tries = randomPoints(10 * static_cast<int>(points.size()), disk,
                                        static_cast<unsigned>(random()));
        for (const auto& p : tries) {
            double nearest = 1e300;
            for (const auto& other : points) nearest = std::min(nearest, glm::distance(p, other));
            if (nearest > farthest) farthest = nearest, best = p;
        }
        points.push_back(best);
    }
    return points;
}

class PoissonDiskTest : public testing::TestWithParam<std::tuple<int, bool>> {
  protected:
    int count() const { return std::get<0>(GetParam()); }
    bool disk() const { return std::get<1>(GetParam()); }
};

TEST_P(PoissonDiskTest, ThereAreAsManyPointsAsAskedForAndAllLieInside) {
    for (const std::uint32_t seed : {0U, 1U, 4000000000U}) {
        const auto points = scene::poissonDisk(count(), disk(), seed);
        EXPECT_EQ(points.size(), static_cast<std::size_t>(count()));
        for (const auto& p : points) EXPECT_TRUE(inside(p, disk())) << p.x << ' ' << p.y;
    }
}

TEST_P(PoissonDiskTest, PointsKeepSixTenthsOfTheLatticesDistance) {
    if (count() == 1) {
        EXPECT_EQ(scene::poissonDisk(1, disk(), 3), Points{glm::dvec2(0)});
        return;
    }
    for (const std::uint32_t seed : {0U, 1U, 2U}) {
        const double least = leastDistance(scene::poissonDisk(count(), disk(), seed));
        EXPECT_GT(least, 0.6 * latticeDistance(count(), disk())) << "seed " << seed;
    }
}

TEST_P(PoissonDiskTest, TheSameSeedGivesTheSamePointsAndAnotherOneOthers) {
    const auto points = scene::poissonDisk(count(), disk(), 5);
    EXPECT_EQ(points, scene::poissonDisk(count(), disk(), 5));
    const bool others = scene::poissonDisk(count(), disk(), 6) != points;
    EXPECT_EQ(others, count() > 1);  // a single point is the centre
}

TEST_P(PoissonDiskTest, PointsFillTheDomainOnAllSides) {
    if (count() < 28) return;
    const auto points = scene::poissonDisk(count(), disk(), 0);
    // No disk of 1.7 lattice distances about a point of the domain is empty
    for (const auto& p : randomPoints(500, disk(), 9)) {
        double nearest = 1e300;
        for (const auto& other : points) nearest = std::min(nearest, glm::distance(p, other));
        EXPECT_LT(nearest, 1.7 * latticeDistance(count(), disk())) << p.x << ' ' << p.y;
    }
}

INSTANTIATE_TEST_SUITE_P(Sets, PoissonDiskTest,
                         testing::Combine(testing::Values(1, 2, 7, 28, 64, 128, 1000, 4096),
                                          testing::Bool()));

TEST(PoissonDiskBaselineTest, PointsLieAsFarApartAsBestCandidatesAndFartherThanRandomOnes) {
    for (const bool disk : {false, true})
        for (const int count : {28, 128}) {
            double poisson = 0, candidates = 0, random = 0;
            for (unsigned seed = 0; seed < 8; ++seed) {
                poisson += leastDistance(scene::poissonDisk(count, disk, seed));
                candidates += leastDistance(bestCandidates(count, disk, seed + 1));
                random += leastDistance(randomPoints(count, disk, seed + 1));
            }
            const double ideal = 8 * latticeDistance(count, disk);
            std::printf(
                "[ DISTANCE ] %d in a %s: Poisson %.2f, best candidates %.2f, random %.2f of the "
                "lattice's\n",
                count, disk ? "disk" : "square", poisson / ideal, candidates / ideal,
                random / ideal);
            EXPECT_GT(poisson, 0.95 * candidates);
            EXPECT_GT(poisson, 5 * random);
        }
}

TEST(PoissonDiskLightTest, ALightsPoissonSamplesAreThesePointsStretchedOverIt) {
    scene::AreaLight light;
    light.width = 0.5;
    light.height = 3;
    scene::SampleChoice choice;
    choice.pattern = scene::Pattern::poisson;
    choice.count = 28;
    choice.seed = 11;
    scene::placeSamples(choice, light);
    const auto points = scene::poissonDisk(28, false, 11);
    ASSERT_EQ(light.samples.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_EQ(light.samples[i], points[i] * glm::dvec2(0.25, 1.5));
}

}  // namespace
}  // namespace penumbra::tests
