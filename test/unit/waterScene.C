/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "waterScene.H"
#include "StringStream.H"

using namespace Foam;
using namespace Foam::mpm;

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

waterScene::waterScene
(
    const meshPlan& plan,
    const vector& g,
    const std::map<std::string, std::string>& patchTypes,
    const std::string& shape,
    const std::string& waterEntries
)
:
    test_(plan)
{
    OStringStream value;
    value << g;
    test_.write
    (
        "constant/g",
        "FoamFile { version 2.0; format ascii;"
        " class uniformDimensionedVectorField; object g; }\n"
        "dimensions [0 1 -2 0 0 0 0]; value " + value.str() + ";\n"
    );
    test_.velocity(patchTypes)().write();

    control_.set("shapeFunction", word(shape));
    grid_.reset(new backgroundGrid(test_.mesh(), control_));

    IStringStream is
    (
        "constitutiveModel weaklyCompressibleNewtonian;"
        "weaklyCompressibleNewtonianCoeffs"
        "{ rho0 " + std::to_string(rho0) + "; mu 0; soundSpeed "
      + std::to_string(soundSpeed) + "; }" + waterEntries
    );
    properties_ = dictionary(is);

    materialPointCloud::settings settings{};
    settings.sortInterval = 1;
    settings.smoothing = true;
    settings.volumeCorrection = true;
    settings.overlapCorrection = false;
    settings.strictKeywords = true;

    cloud_.reset
    (
        new waterCloud
        (
            "water", test_.mesh(), *grid_, properties_, settings, cost_, g
        )
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void waterScene::fill
(
    const int n,
    const std::function<scalar(const point&)>& part,
    const std::function<vector(const point&)>& velocity,
    const std::function<scalar(const point&)>& pressure,
    const std::function<point(const point&)>& moved
)
{
    const lattice& cells = grid_->cells();
    const fvMesh& mesh = test_.mesh();
    const bool is3D = cells.nDim() == 3;
    const scalar volume = cells.cellVolume()/(n*n*(is3D ? n : 1));

    DynamicList<point> position;
    DynamicList<label> cell;
    DynamicList<scalar> id, volumes, pressures;
    DynamicList<vector> velocities;

    for (label celli = 0; celli < mesh.nCells(); ++celli)
    {
        for (int k = 0; k < (is3D ? n : 1); ++k)
        for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
        {
            const int number[3] = {i, j, k};
            point x(mesh.cellCentres()[celli]);
            for (label d = 0; d < cells.nDim(); ++d)
            {
                x[cells.axis(d)] +=
                    ((number[d] + 0.5)/n - 0.5)*cells.spacing(d);
            }
            const scalar p = part(x);
            if (!(p > 0)) continue;

            velocities.append(velocity(x));
            pressures.append(pressure(x));
            x = moved(x);

            // The lattice may have cells left out: look for it
            label home = -1;
            for (label c = 0; c < mesh.nCells(); ++c)
            {
                const vector d(cmptMag(x - mesh.cellCentres()[c]));
                bool in = true;
                for (label k = 0; k < cells.nDim(); ++k)
                {
                    in = in && d[cells.axis(k)] <= 0.5*cells.spacing(k);
                }
                if (in) home = c;
            }
            if (home < 0)
            {
                FatalErrorInFunction
                    << "no cell at " << x << exit(FatalError);
            }
            position.append(x);
            cell.append(home);
            id.append(id.size());
            volumes.append(p*volume);
        }
    }

    const label first = cloud_->addPoints(position, cell, id, velocities);
    cloud_->setState(first, volumes, pressures);
}

// ************************************************************************* //
