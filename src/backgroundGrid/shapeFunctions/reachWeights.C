/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "reachWeights.H"
#include "backgroundGrid.H"

// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::mpm::reachWeights
(
    const backgroundGrid& grid,
    const scalar f,
    scalar (&w)[4],
    scalar (&g)[4]
)
{
    scalar q[4];
    if (grid.tileWidth() == linear::width)
    {
        linear::reachWeights(f, w, q, g);
    }
    else if (grid.tileWidth() == quadraticBSpline::width)
    {
        quadraticBSpline::reachWeights(f, w, q, g);
    }
    else
    {
        cubicBSpline::reachWeights(f, w, q, g);
    }
}

// ************************************************************************* //
