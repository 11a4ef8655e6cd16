/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "vectorInTime.H"
#include "timeFunction.H"
#include <cmath>

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::vectorInTime::vectorInTime
(
    const dictionary& dict,
    const word& keyword,
    const dimensionSet& dims,
    const lattice& cells
)
:
    dict_(dict),
    keyword_(keyword),
    empty_(cells.nDim() == 2 ? cells.axis(2) : -1),
    function_(readTimeFunction<vector>(dict, keyword, dims))
{
    value(0);
}


Foam::autoPtr<Foam::mpm::vectorInTime> Foam::mpm::vectorInTime::New
(
    const dictionary& dict,
    const word& keyword,
    const dimensionSet& dims,
    const lattice& cells
)
{
    return autoPtr<vectorInTime>
    (
        dict.found(keyword)
      ? new vectorInTime(dict, keyword, dims, cells)
      : nullptr
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::vector Foam::mpm::vectorInTime::value(const scalar time) const
{
    const vector v(function_->value(time));

    bool finite = true;
    for (direction d = 0; d < vector::nComponents; ++d)
    {
        finite = finite && std::isfinite(v[d]);
    }
    if (!finite || (empty_ >= 0 && mag(v[empty_]) > SMALL))
    {
        FatalIOErrorInFunction(dict_)
            << "keyword " << keyword_ << " is " << v << " at " << time << " s."
            << nl << "    Allowed: numbers";
        if (empty_ >= 0)
        {
            FatalIOError
                << ", and 0 in direction " << vector::componentNames[empty_]
                << ", in which the case is empty";
        }
        FatalIOError<< exit(FatalIOError);
    }
    return v;
}

// ************************************************************************* //
