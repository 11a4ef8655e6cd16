/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "testMesh.H"
#include "columnSurfaces.H"
#include <cmath>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

const scalar h = 0.1;
const scalar bedFraction = 0.6;

//- Fractions of the cells of one column, from below
typedef std::vector<scalar> column;


//- A mesh of one column for each case, the fractions on it
struct columns
{
    testMesh test;
    backgroundGrid grid;

    static meshPlan plan(const std::vector<column>& soil, const bool upward)
    {
        const int rows = soil[0].size();
        meshPlan p;
        p.n = Vector<label>(soil.size(), rows, 1);
        p.size = vector(h, h, h);
        // Cells with a negative fraction are solid
        p.present = [=](const int i, const int j, const int)
        {
            return soil[i][upward ? j : rows - 1 - j] >= 0;
        };
        return p;
    }

    columns(const std::vector<column>& soil, const bool upward = true)
    :
        test(plan(soil, upward)),
        grid(test.mesh(), dictionary())
    {}

    tmp<volScalarField> field
    (
        const std::vector<column>& values,
        const bool upward = true
    )
    {
        tmp<volScalarField> f
        (
            new volScalarField
            (
                IOobject("f", test.time().timeName(), test.mesh()),
                test.mesh(),
                dimensionedScalar(dimless, Zero)
            )
        );
        const int rows = values[0].size();
        for (label celli = 0; celli < test.mesh().nCells(); ++celli)
        {
            const index3& i = grid.cells().cellIndex(celli);
            const int row = upward ? i[1] : rows - 1 - i[1];
            f.ref()[celli] = values[i[0]][row];
        }
        return f;
    }
};


columnSurfaces::heights find
(
    const std::vector<column>& soil,
    const std::vector<column>& water,
    const bool upward = true
)
{
    columns c(soil, upward);
    const columnSurfaces surfaces(c.grid, 0, 1, upward);
    return surfaces.find
    (
        c.field(soil, upward)(), &c.field(water, upward)(), bedFraction
    );
}

const column none(8, 0);

} // End anonymous namespace


TEST_CASE("columnSurfaces: the bed")
{
    const std::vector<column> soil
    ({
        // Solids of one cell are admitted at the ends of the mesh only
        {-1, -1, 0.6, 0.6, 0, 0, 0, 0},         // on a step
        {0.6, 0.6, 0.6, 0.6, 0, 0, 0, 0},       // between cells
        {0.6, 0.6, 0.6, 0.4, 0, 0, 0, 0},       // inside a cell
        {0.15, 0, 0, 0, 0, 0, 0, 0},            // thin layer
        {0, 0, 0, 0, 0, 0, 0, 0},               // none
        {0.6, 0.6, 0, 0, 0.5, 0.6, 0, 0},       // grains that float
        {0.6, 0.6, 0.1, 0.6, 0.6, 0, 0, 0},     // a bubble
        {0.6, 0.6, 0.1, 0.6, 0, 0, 0, 0},       // a grain that jumps
        {0.6, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6},   // up to the lid
        {0.3, 0, 0, 0, 0, 0, 0, 0},             // half a cell
        {0.6, 0.6, -1, -1, 0, 0, 0, 0}          // under a gate
    });
    const scalar expected[] =
    {
        0.4, 0.4, 0.35 + 0.1*0.25, 0.025, 0, 0.2, 0.5, 0.15 + 0.1*0.6, 0.8,
        0.05, 0.2
    };
    for (const bool upward : {true, false})
    {
        const scalarField bed
        (
            find(soil, std::vector<column>(soil.size(), none), upward).bed
        );
        REQUIRE(bed.size() == label(soil.size()));

        // Heights count from y = 0; upside down, this is the lid
        const scalar floor = upward ? 0 : -0.8;
        forAll(bed, i)
        {
            atMost
            (
                "column " + std::to_string(i)
              + (upward ? "" : ", upside down") + ": error of the bed [m]",
                std::abs(bed[i] - floor - expected[i]),
                1e-12
            );
        }
    }
}


TEST_CASE("columnSurfaces: the water")
{
    const std::vector<column> soil
    ({
        none,
        {0.6, 0.6, 0, 0, 0, 0, 0, 0},
        {0.6, 0.6, 0, 0, 0, 0, 0, 0},
        none,
        {0.6, 0.6, 0, 0, 0, 0, 0, 0},
        none,
        none
    });
    const std::vector<column> water
    ({
        {1, 1, 1, 0.75, 0, 0, 0, 0},        // inside a cell
        {0.4, 0.4, 1, 1, 0, 0, 0, 0},       // over a bed
        {0.4, 0.4, 0, 0, 0, 0, 0, 0},       // in its pores only
        {1, 1, 0.1, 0.2, 1, 0, 0, 0},       // over enclosed air
        {0, 0, 0, 0, 0, 0, 0, 0},           // none
        {0.3, 0, 0, 0, 0, 0, 0, 0},         // a film
        {1, 1, 1, 0, 0.3, 0, 0, 0}          // spray
    });
    const scalarField level(find(soil, water).water);
    const scalar expected[] =
    {
        0.35 + 0.1*0.25/0.75, 0.4, 0.2, 0.5, std::nan(""), 0.03, 0.3
    };
    forAll(level, i)
    {
        const std::string column("column " + std::to_string(i));
        if (std::isnan(expected[i]))
        {
            equal(column + ": level", std::isnan(level[i]) ? "none" : "one", "none");
            continue;
        }
        atMost
        (
            column + ": error of the level [m]",
            std::abs(level[i] - expected[i]),
            1e-12
        );
    }
}
