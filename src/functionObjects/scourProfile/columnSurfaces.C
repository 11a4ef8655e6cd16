/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "columnSurfaces.H"
#include "volFields.H"
#include "PstreamReduceOps.H"
#include <limits>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::label Foam::mpm::columnSurfaces::place(const index3& i) const
{
    const label across = grid_.nDim() == 3 ? i[horizontal_[1]] : 0;
    const label column = i[horizontal_[0]] + nColumns_[0]*across;
    const label row = upward_ ? i[vertical_] : nRows() - 1 - i[vertical_];
    return column*nRows() + row;
}


Foam::scalar Foam::mpm::columnSurfaces::crossing
(
    const scalar* fraction,
    const label k,
    const scalar limit
) const
{
    // Below the lid of the mesh, or a solid
    if (k + 1 == nRows() || fraction[k + 1] < 0) return height(k + 1);

    const scalar part = (fraction[k] - limit)/(fraction[k] - fraction[k + 1]);
    const scalar h = grid_.cells().spacing(vertical_);
    return height(k) + (0.5 + part)*h;
}


Foam::scalar Foam::mpm::columnSurfaces::bedHeight
(
    const scalar* soil,
    const label floor,
    const scalar bedFraction
) const
{
    const scalar limit = 0.5*bedFraction;
    if (soil[floor] < limit)
    {
        return height(floor)
          + soil[floor]/bedFraction*grid_.cells().spacing(vertical_);
    }

    auto isBed = [&](const label k) { return k < nRows() && soil[k] >= limit; };

    label k = floor;
    while (isBed(k + 1) || (isBed(k + 2) && isBed(k + 3) && soil[k + 1] >= 0))
    {
        ++k;
    }
    return crossing(soil, k, limit);
}


Foam::scalar Foam::mpm::columnSurfaces::waterHeight
(
    const scalar* total,
    const label floor
) const
{
    label k = nRows() - 1;
    while (k > floor && total[k] < 0.5) --k;

    if (total[k] < 0.5)
    {
        return height(floor)
          + max(scalar(0), total[floor])*grid_.cells().spacing(vertical_);
    }
    return crossing(total, k, 0.5);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::columnSurfaces::columnSurfaces
(
    const backgroundGrid& grid,
    const label along,
    const label vertical,
    const bool upward
)
:
    grid_(grid),
    vertical_(vertical),
    upward_(upward),
    horizontal_{along, along},
    nColumns_{grid.cells().nCells(along), 1}
{
    for (label d = 0; d < grid.nDim(); ++d)
    {
        if (d != along && d != vertical)
        {
            horizontal_[1] = d;
            nColumns_[1] = grid.cells().nCells(d);
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::columnSurfaces::coordinate(const label station) const
{
    const lattice& cells = grid_.cells();
    return cells.origin(horizontal_[0])
      + (station + 0.5)*cells.spacing(horizontal_[0]);
}


Foam::scalar Foam::mpm::columnSurfaces::area() const
{
    const lattice& cells = grid_.cells();
    return cells.cellVolume()/cells.spacing(vertical_)/cells.thickness();
}


Foam::scalar Foam::mpm::columnSurfaces::height(const label row) const
{
    const lattice& cells = grid_.cells();
    const scalar h = cells.spacing(vertical_);
    const scalar lowest =
        upward_
      ? cells.origin(vertical_)
      : -(cells.origin(vertical_) + nRows()*h);
    return lowest + row*h;
}


Foam::label Foam::mpm::columnSurfaces::column(const label cell) const
{
    return place(grid_.cells().cellIndex(grid_.meshCell(cell)))/nRows();
}


Foam::scalarField Foam::mpm::columnSurfaces::gather
(
    const volScalarField& field
) const
{
    scalarField values(nColumns()*nRows(), scalar(-1));
    forAll(field, celli)
    {
        values[place(grid_.cells().cellIndex(celli))] =
            max(scalar(0), field[celli]);
    }
    Pstream::listCombineGather(values, maxEqOp<scalar>());
    Pstream::listCombineScatter(values);
    return values;
}


Foam::scalarField Foam::mpm::columnSurfaces::gather
(
    const volVectorField& field,
    const label d
) const
{
    const direction axis = grid_.cells().axis(d);
    scalarField values(nColumns()*nRows(), Zero);
    forAll(field, celli)
    {
        values[place(grid_.cells().cellIndex(celli))] = field[celli][axis];
    }
    Pstream::listCombineGather(values, plusEqOp<scalar>());
    Pstream::listCombineScatter(values);
    return values;
}


Foam::mpm::columnSurfaces::heights Foam::mpm::columnSurfaces::find
(
    const volScalarField& soil,
    const volScalarField* water,
    const scalar bedFraction
) const
{
    const scalar nan = std::numeric_limits<scalar>::quiet_NaN();
    const scalarField alphaSoil(gather(soil));
    const scalarField alphaWater
    (
        water ? gather(*water) : scalarField(alphaSoil.size(), Zero)
    );

    heights h{scalarField(nColumns(), nan), scalarField(nColumns(), nan)};

    for (label c = 0; c < nColumns(); ++c)
    {
        const label first = c*nRows();
        label floor = 0;
        while (floor < nRows() && alphaSoil[first + floor] < 0) ++floor;
        if (floor == nRows()) continue;

        h.bed[c] = bedHeight(&alphaSoil[first], floor, bedFraction);

        scalarField total(nRows());
        scalar most = 0;
        forAll(total, k)
        {
            // Stays negative where there is no cell
            const scalar water = max(scalar(0), alphaWater[first + k]);
            total[k] = alphaSoil[first + k] + water;
            most = max(most, water);
        }
        if (most > SMALL) h.water[c] = waterHeight(total.cdata(), floor);
    }
    return h;
}

// ************************************************************************* //
