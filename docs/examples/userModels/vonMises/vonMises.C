/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "vonMises.H"
#include "soilTensor.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(vonMises, 0);
    addToRunTimeSelectionTable(soilModel, vonMises, dictionary);
}
}

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

//- The coefficients that linearElastic knows
static Foam::dictionary elasticPart(const Foam::dictionary& coeffs)
{
    Foam::dictionary elastic(coeffs);
    elastic.remove("qYield");
    return elastic;
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<int dim>
void Foam::mpm::vonMises::yield(soilPoints& points) const
{
    constexpr int n = nComponents<dim>;

    for (label i = 0; i < points.n; ++i)
    {
        scalar s[n];
        for (int c = 0; c < n; ++c) s[c] = points.stress[c][i];
        const scalar mean = (s[0] + s[1] + s[2])/3;
        for (int c = 0; c < 3; ++c) s[c] -= mean;

        const scalar q = std::sqrt(1.5*doubleDot<dim>(s, s));
        if (q <= qYield_) continue;

        for (int c = 0; c < n; ++c)
        {
            s[c] = qYield_/q*s[c] + (c < 3 ? mean : 0);
            points.stress[c][i] = points.wholeStress[c][i] = s[c];
        }
        if (points.power)
        {
            points.power[i] = doubleDot<dim>(s, soilRates<dim>(points, i).D);
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::vonMises::vonMises
(
    const dictionary& coeffs,
    const bool strictKeywords
)
:
    linearElastic(elasticPart(coeffs), strictKeywords),
    qYield_(readPositive(coeffs, "qYield", dimPressure))
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::vonMises::update
(
    const label dim,
    soilPoints& points,
    const scalar deltaT
) const
{
    linearElastic::update(dim, points, deltaT);
    if (dim == 2) yield<2>(points);
    else yield<3>(points);
}

// ************************************************************************* //
