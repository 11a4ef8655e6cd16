/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "lagrangianGeometry.H"
#include "passiveParticle.H"
#include "Time.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(lagrangianGeometry, 0);
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::lagrangianGeometry::findTetrahedron
(
    const point& x,
    const label celli,
    label& facei,
    label& pointi
) const
{
    const cell& faces = mesh_.cells()[celli];
    const point& centre = mesh_.cellCentres()[celli];

    // The face whose pyramid holds the point; any face will do for a position
    // that is not finite, which is written for inspection
    facei = faces[0];
    scalar largest = -GREAT;
    for (const label f : faces)
    {
        const vector toFace = mesh_.faceCentres()[f] - centre;
        const scalar along = (x - centre) & toFace/magSqr(toFace);
        if (along > largest)
        {
            largest = along;
            facei = f;
        }
    }

    // The triangle of that face: the one whose barycentric coordinates are
    // least negative
    scalar best = -GREAT;
    pointi = 1;
    for (label pt = 1; pt < mesh_.faces()[facei].size() - 1; ++pt)
    {
        const barycentric b =
            tetIndices(celli, facei, pt).tet(mesh_).pointToBarycentric(x);
        const scalar least = cmptMin(b);
        if (least > best)
        {
            best = least;
            pointi = pt;
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::lagrangianGeometry::lagrangianGeometry
(
    const cloud::geometryType type,
    const objectRegistry& cloudRegistry,
    const polyMesh& mesh,
    const UList<point>& position,
    const labelUList& cell
)
:
    regIOobject
    (
        IOobject
        (
            cloud::geometryTypeNames[type],
            cloudRegistry.time().timeName(),
            cloudRegistry,
            IOobject::NO_READ,
            IOobject::NO_WRITE,
            false
        )
    ),
    type_(type),
    mesh_(mesh),
    position_(position),
    cell_(cell)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::lagrangianGeometry::writeData(Ostream& os) const
{
    os  << position_.size() << nl << token::BEGIN_LIST << nl;

    forAll(position_, i)
    {
        label facei, pointi;
        findTetrahedron(position_[i], cell_[i], facei, pointi);
        const barycentric coordinates =
            tetIndices(cell_[i], facei, pointi).tet(mesh_)
           .pointToBarycentric(position_[i]);

        const passiveParticle p
        (
            mesh_, coordinates, cell_[i], facei, pointi
        );
        if (type_ == cloud::geometryType::COORDINATES)
        {
            p.writeCoordinates(os);
        }
        else
        {
            p.writePosition(os);
        }
        os  << nl;
    }
    os  << token::END_LIST << endl;

    return os.good();
}

// ************************************************************************* //
