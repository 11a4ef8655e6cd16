/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "testMesh.H"
#include "cellModel.H"
#include "OSspecific.H"
#include "polyPatch.H"
#include <array>
#include <cstdlib>
#include <fstream>

using namespace Foam;

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

temporaryDirectory::temporaryDirectory()
{
    std::string name = "/tmp/mpmUnitTests.XXXXXX";
    if (!mkdtemp(name.data()))
    {
        FatalErrorInFunction << "no temporary directory" << exit(FatalError);
    }
    path = name;
}


temporaryDirectory::~temporaryDirectory()
{
    rmDir(path);
}


testMesh::testMesh(const meshPlan& plan)
{
    dictionary control;
    control.set("startTime", 0);
    control.set("endTime", 1);
    control.set("deltaT", 0.001);
    control.set("writeInterval", 1);
    control.set("writePrecision", 12);
    time_.reset
    (
        new Time
        (
            control, directory_.path.path(), directory_.path.name(),
            "system", "constant", false, false
        )
    );

    // Points in use, and the cells
    std::map<std::array<int, 3>, label> number;
    DynamicList<point> points;
    auto vertex = [&](const int i, const int j, const int k)
    {
        const std::array<int, 3> key{i, j, k};
        const auto found = number.find(key);
        if (found != number.end()) return found->second;
        number[key] = points.size();
        const vector x
        (
            plan.origin.x() + i*plan.size.x(),
            plan.origin.y() + j*plan.size.y(),
            plan.origin.z() + k*plan.size.z()
        );
        points.append(plan.map(x));
        return points.size() - 1;
    };

    const cellModel& hex = cellModel::ref(cellModel::HEX);
    DynamicList<cellShape> cells;
    for (int k = 0; k < plan.n.z(); ++k)
    for (int j = 0; j < plan.n.y(); ++j)
    for (int i = 0; i < plan.n.x(); ++i)
    {
        if (!plan.present(i, j, k)) continue;
        cells.append
        (
            cellShape
            (
                hex,
                labelList
                ({
                    vertex(i, j, k), vertex(i + 1, j, k),
                    vertex(i + 1, j + 1, k), vertex(i, j + 1, k),
                    vertex(i, j, k + 1), vertex(i + 1, j, k + 1),
                    vertex(i + 1, j + 1, k + 1), vertex(i, j + 1, k + 1)
                })
            )
        );
    }

    // Faces at which a cell ends, by patch
    std::map<std::string, DynamicList<face>> faces;
    label celli = 0;
    for (int k = 0; k < plan.n.z(); ++k)
    for (int j = 0; j < plan.n.y(); ++j)
    for (int i = 0; i < plan.n.x(); ++i)
    {
        if (!plan.present(i, j, k)) continue;
        const faceList sides(cells[celli++].faces());

        for (int side = 0; side < 6; ++side)
        {
            Vector<label> o(i, j, k);
            o[side/2] += (side % 2 ? 1 : -1);
            const bool inner =
                cmptMin(o) >= 0
             && o.x() < plan.n.x() && o.y() < plan.n.y() && o.z() < plan.n.z()
             && plan.present(o.x(), o.y(), o.z());
            if (inner) continue;

            const face& f = sides[side];
            std::string name =
                plan.patch(f.centre(points), f.unitNormal(points));
            if (name.empty())
            {
                name = side/2 == plan.empty ? "frontAndBack" : "walls";
            }
            faces[name].append(f);
        }
    }

    faceListList patchFaces(faces.size());
    wordList names(faces.size());
    PtrList<dictionary> patches(faces.size());
    label patchi = 0;
    for (const auto& entry : faces)
    {
        const auto given = plan.type.find(entry.first);
        const std::string type =
            given != plan.type.end() ? given->second
          : entry.first == "frontAndBack" ? "empty" : "wall";

        names[patchi] = entry.first;
        patchFaces[patchi] = entry.second;
        patches.set(patchi, new dictionary);
        patches[patchi].set("type", word(type));
        if (type == "cyclic")
        {
            static const std::map<std::string, std::string> partner
            ({
                {"left", "right"}, {"right", "left"}, {"bottom", "top"},
                {"top", "bottom"}, {"back", "front"}, {"front", "back"}
            });
            patches[patchi].set
            (
                "neighbourPatch", word(partner.at(entry.first))
            );
        }
        ++patchi;
    }

    // fvMesh has no constructor from shapes
    polyMesh shapes
    (
        IOobject
        (
            "shapes", time_->constant(), *time_, IOobject::NO_READ,
            IOobject::NO_WRITE, false
        ),
        pointField(points), cellShapeList(cells), patchFaces, names, patches,
        "unnamed", "wall"
    );
    mesh_.reset
    (
        new fvMesh
        (
            IOobject(polyMesh::defaultRegion, time_->constant(), *time_),
            pointField(shapes.points()),
            faceList(shapes.faces()),
            labelList(shapes.faceOwner()),
            labelList(shapes.faceNeighbour())
        )
    );

    List<polyPatch*> copies(shapes.boundaryMesh().size());
    forAll(copies, i)
    {
        copies[i] =
            shapes.boundaryMesh()[i].clone(mesh_->boundaryMesh()).ptr();
    }
    mesh_->addFvPatches(copies);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

tmp<volVectorField> testMesh::velocity
(
    const std::map<std::string, std::string>& types,
    const word& name
)
{
    wordList patchTypes(mesh_->boundary().size(), "slip");
    forAll(patchTypes, i)
    {
        const polyPatch& pp = mesh_->boundaryMesh()[i];
        const auto given = types.find(pp.name());
        if (given != types.end()) patchTypes[i] = given->second;
        if (polyPatch::constraintType(pp.type())) patchTypes[i] = pp.type();
    }

    return tmp<volVectorField>
    (
        new volVectorField
        (
            IOobject
            (
                name, time_->timeName(), *mesh_, IOobject::NO_READ,
                IOobject::NO_WRITE, false
            ),
            *mesh_,
            dimensionedVector(dimVelocity, Zero),
            patchTypes
        )
    );
}


void testMesh::write(const fileName& file, const std::string& text) const
{
    mkDir((path()/file).path());
    std::ofstream(path()/file) << text;
}


std::string hullSides
(
    const meshPlan& plan,
    const point& centre,
    const vector& normal
)
{
    static const char* names[6] =
        {"left", "right", "bottom", "top", "back", "front"};

    for (int c = 0; c < 3; ++c)
    {
        if (mag(normal[c]) < 0.9) continue;
        const scalar end =
            plan.origin[c] + (normal[c] > 0 ? plan.n[c]*plan.size[c] : 0);
        if (c != plan.empty && mag(centre[c] - end) < 1e-6*plan.size[c])
        {
            return names[2*c + (normal[c] > 0)];
        }
    }
    return "";
}

// ************************************************************************* //
