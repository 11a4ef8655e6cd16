/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "lattice.H"
#include "latticeDiagnosis.H"
#include "SubField.H"
#include "emptyPolyPatch.H"
#include "wedgePolyPatch.H"
#include "cyclicPolyPatch.H"
#include "processorPolyPatch.H"
#include "Time.H"
#include "labelIOList.H"
#include "polyBoundaryMeshEntries.H"
#include "PstreamReduceOps.H"
#include <unordered_set>

namespace
{
    //- Admissible deviation of a cell from the lattice, in cell sizes.
    //  blockMesh writes 10 significant digits; 1e-4 leaves room for meshes
    //  that passed through utilities writing fewer.
    const Foam::scalar latticeTolerance = 1e-4;
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::fileName Foam::mpm::lattice::where() const
{
    return mesh_.pointsInstance()/mesh_.meshDir();
}


void Foam::mpm::lattice::findDirections()
{
    // Area of empty faces by the component their normal follows
    vector emptyArea(Zero);

    for (const polyPatch& pp : mesh_.boundaryMesh())
    {
        if (isA<wedgePolyPatch>(pp))
        {
            FatalErrorInFunction
                << "patch " << pp.name() << " of " << where()
                << " has type wedge." << nl
                << "    mpmFoam solves in two or three Cartesian dimensions;"
                << " use type empty (2D) or a wall." << exit(FatalError);
        }
        if (isA<emptyPolyPatch>(pp))
        {
            const vectorField::subField areas = pp.faceAreas();
            forAll(areas, i)
            {
                for (direction c = 0; c < 3; ++c)
                {
                    emptyArea[c] += mag(areas[i][c]);
                }
            }
        }
    }
    reduce(emptyArea, sumOp<vector>());

    nDim_ = 3;
    axis_ = {0, 1, 2};

    if (cmptMax(emptyArea) > VSMALL)
    {
        nDim_ = 2;
        label e = 0;
        for (label c = 1; c < 3; ++c)
        {
            if (emptyArea[c] > emptyArea[e]) e = c;
        }
        label d = 0;
        for (label c = 0; c < 3; ++c)
        {
            if (c != e) axis_[d++] = c;
        }
        axis_[2] = e;

        for (const polyPatch& pp : mesh_.boundaryMesh())
        {
            if (!isA<emptyPolyPatch>(pp)) continue;

            const vectorField::subField areas = pp.faceAreas();
            const vectorField::subField centres = pp.faceCentres();
            forAll(areas, i)
            {
                if (mag(areas[i][e]) < 0.999*mag(areas[i]))
                {
                    FatalErrorInFunction
                        << "patch " << pp.name() << " of " << where()
                        << " has type empty, but its face at " << centres[i]
                        << " does not face the empty direction "
                        << vector::componentNames[e] << '.' << nl
                        << "    A hole cut by subsetMesh lands its faces in"
                        << " such a patch: cut with -patch <wall patch>."
                        << exit(FatalError);
                }
            }
        }
    }
}


void Foam::mpm::lattice::findSpacing()
{
    // The first cell of the lowest rank that has cells sets the cell size
    vector size(Zero);
    label first = (mesh_.nCells() ? Pstream::myProcNo() : labelMax);
    reduce(first, minOp<label>());

    if (first == labelMax)
    {
        FatalErrorInFunction
            << "the mesh in " << where() << " has no cells."
            << exit(FatalError);
    }
    if (first == Pstream::myProcNo())
    {
        size = boundBox(mesh_.points(), mesh_.cellPoints()[0], false).span();
    }
    reduce(size, sumOp<vector>());

    boundBox bb(mesh_.points(), true);

    // Dividing the whole extent is more exact than the size of one cell
    for (label d = 0; d < 3; ++d)
    {
        const label c = axis_[d];
        const scalar extent = bb.span()[c];
        nCells_[d] = max(label(1), label(std::lround(extent/size[c])));
        spacing_[d] = extent/nCells_[d];
        origin_[d] = bb.min()[c];
        periodic_[d] = false;
    }

    for (const polyPatch& pp : mesh_.boundaryMesh())
    {
        if (isA<cyclicPolyPatch>(pp))
        {
            vector n(Zero);
            if (pp.size()) n = cmptMag(pp.faceAreas()[0]);
            reduce(n, maxOp<vector>());

            for (label d = 0; d < nDim_; ++d)
            {
                if (n[axis_[d]] > 0.999*mag(n)) periodic_[d] = true;
            }
        }
    }

    // decomposePar may leave all faces of a cyclic in processorCyclic patches
    for (label d = 0; d < nDim_; ++d)
    {
        bool found = false;
        for (const polyPatch& pp : mesh_.boundaryMesh())
        {
            if
            (
                pp.type() == "processorCyclic" && pp.size()
             && mag(pp.faceAreas()[0][axis_[d]]) > 0.999*mag(pp.faceAreas()[0])
            )
            {
                found = true;
            }
        }
        reduce(found, orOp<bool>());
        periodic_[d] = periodic_[d] || found;
    }
}


void Foam::mpm::lattice::findCells()
{
    cellIndex_.setSize(mesh_.nCells());

    forAll(cellIndex_, celli)
    {
        const boundBox bb(mesh_.points(), mesh_.cellPoints()[celli], false);
        const vector span = bb.span();

        // A sheared hexahedron has less volume than its bounding box
        const scalar boxVolume = span.x()*span.y()*span.z();
        bool ok =
            mesh_.cells()[celli].size() == 6
         && mesh_.cellPoints()[celli].size() == 8
         && mag(mesh_.cellVolumes()[celli] - boxVolume)
          < 10*latticeTolerance*boxVolume;

        for (label d = 0; d < 3; ++d)
        {
            const label c = axis_[d];
            const scalar xi = (bb.centre()[c] - origin_[d])/spacing_[d] - 0.5;
            const label i = std::lround(xi);

            ok = ok
             && mag(span[c] - spacing_[d]) < latticeTolerance*spacing_[d]
             && mag(xi - i) < latticeTolerance*max(label(1), nCells_[d]/10);

            cellIndex_[celli][d] = i;
        }

        if (!ok)
        {
            FatalErrorInFunction
                << "the mesh in " << where() << " is not uniform." << nl
                << "    First offending cell: " << celli << " at "
                << bb.centre() << " with " << mesh_.cells()[celli].size()
                << " faces, extent " << span << " and volume "
                << mesh_.cellVolumes()[celli] << nl
                << "    Expected: axis-aligned hexahedra, all of the size (";
            vector expected;
            for (label d = 0; d < 3; ++d) expected[axis_[d]] = spacing_[d];
            FatalError
                << expected.x() << ' ' << expected.y() << ' ' << expected.z()
                << "). Blocks may be missing; grading, shear and polyhedra"
                << " are not admitted."
                << latticeDiagnosis(mesh_).text().c_str()
                << exit(FatalError);
        }
    }

    if (nDim_ == 2 && nCells_[2] != 1)
    {
        FatalErrorInFunction
            << "the mesh in " << where() << " has " << nCells_[2]
            << " cells in its empty direction; one is allowed."
            << exit(FatalError);
    }
}


void Foam::mpm::lattice::checkBaffles() const
{
    // Two faces of different patches in one place: a wall without thickness
    const polyBoundaryMesh& patches = mesh_.boundaryMesh();
    std::unordered_set<int64_t> seen;

    for (const polyPatch& pp : patches)
    {
        if (pp.coupled() || isA<emptyPolyPatch>(pp)) continue;

        forAll(pp, i)
        {
            label d, side;
            faceDirection(pp.faceAreas()[i], d, side);
            if (d < 0) continue;

            index3 key = cellIndex_[pp.faceCells()[i]];
            if (side) ++key[d];
            int64_t id = key[2];
            id = id*(nCells_[1] + 1) + key[1];
            id = id*(nCells_[0] + 1) + key[0];

            if (!seen.insert(3*id + d).second)
            {
                FatalErrorInFunction
                    << "patch " << pp.name() << " of " << where()
                    << " is a wall without thickness at "
                    << pp.faceCentres()[i] << '.' << nl
                    << "    Walls between two fluid regions need at least two"
                    << " cells that are left out of the mesh."
                    << exit(FatalError);
            }
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::lattice::lattice(const polyMesh& mesh)
:
    mesh_(mesh)
{
    findDirections();
    findSpacing();
    findCells();
    checkBaffles();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::lattice::checkFiles(const Time& runTime)
{
    auto file = [&](const word& name, const IOobject::readOption read)
    {
        return IOobject
        (
            name,
            runTime.findInstance(polyMesh::meshSubDir, "faces"),
            polyMesh::meshSubDir,
            runTime,
            read,
            IOobject::NO_WRITE,
            false
        );
    };

    // Meshes of an older format have one file of cells instead
    if (!file("owner", IOobject::MUST_READ).typeHeaderOk<labelIOList>(true))
    {
        return;
    }
    const labelIOList owner(file("owner", IOobject::MUST_READ));
    const labelIOList neighbour(file("neighbour", IOobject::READ_IF_PRESENT));
    const polyBoundaryMeshEntries patches
    (
        file("boundary", IOobject::MUST_READ)
    );

    label nFaces = neighbour.size();
    for (const entry& e : patches)
    {
        nFaces = max
        (
            nFaces,
            e.dict().get<label>("startFace") + e.dict().get<label>("nFaces")
        );
    }
    if (nFaces != owner.size())
    {
        FatalErrorInFunction
            << "the mesh in " << owner.path() << " is broken: file owner has "
            << owner.size() << " faces, but boundary and neighbour have "
            << nFaces << '.' << nl << "    Make the mesh again."
            << exit(FatalError);
    }

    // Cells are numbered without gaps, so that each has faces; there are less
    // cells than faces
    labelList nCellFaces
    (
        owner.empty() ? 0 : min(max(owner) + 1, owner.size()), Zero
    );
    for (const labelIOList* list : {&owner, &neighbour})
    {
        forAll(*list, facei)
        {
            const label celli = (*list)[facei];

            if (celli < 0 || celli >= nCellFaces.size())
            {
                FatalErrorInFunction
                    << "the mesh in " << owner.path() << " is broken: file "
                    << list->name() << " gives face " << facei << " to cell "
                    << celli << '.' << nl
                    << "    Allowed: cells from 0 on, without gaps. Make the"
                    << " mesh again." << exit(FatalError);
            }
            ++nCellFaces[celli];
        }
    }
    forAll(nCellFaces, celli)
    {
        if (nCellFaces[celli] >= 4) continue;
        FatalErrorInFunction
            << "the mesh in " << owner.path() << " is broken: of the cells 0"
            << " to " << nCellFaces.size() - 1 << " of the files owner and"
            << " neighbour, " << celli << " has " << nCellFaces[celli]
            << " faces." << nl
            << "    Allowed: cells with faces all around. Make the mesh again."
            << exit(FatalError);
    }
}


Foam::scalar Foam::mpm::lattice::minSpacing() const
{
    scalar h = spacing_[0];
    for (label d = 1; d < nDim_; ++d) h = min(h, spacing_[d]);
    return h;
}


Foam::scalar Foam::mpm::lattice::cellVolume() const
{
    return spacing_[0]*spacing_[1]*spacing_[2];
}


Foam::scalar Foam::mpm::lattice::thickness() const
{
    return nDim_ == 2 ? spacing_[2] : 1;
}


Foam::scalar Foam::mpm::lattice::midPlane() const
{
    return nDim_ == 2 ? origin_[2] + 0.5*spacing_[2] : 0;
}


Foam::label Foam::mpm::lattice::along(const vector& v) const
{
    label result = 0;
    for (label d = 1; d < nDim_; ++d)
    {
        if (mag(v[axis_[d]]) > mag(v[axis_[result]])) result = d;
    }
    return result;
}


void Foam::mpm::lattice::faceDirection
(
    const vector& n,
    label& d,
    label& side
) const
{
    d = -1;
    side = 0;
    for (label k = 0; k < nDim_; ++k)
    {
        const scalar nk = n[axis_[k]];
        if (mag(nk) > 0.9*mag(n))
        {
            d = k;
            side = (nk > 0 ? 1 : 0);
            return;
        }
    }
}

// ************************************************************************* //
