/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "materialPointHDF5.H"
#include "dictionaryEntries.H"
#include "listed.H"
#include "ListOps.H"
#include "stringListOps.H"
#include "OSspecific.H"
#include "clockTime.H"
#include "IPstream.H"
#include "OPstream.H"
#include "PstreamReduceOps.H"
#include "functionNeeds.H"
#include "addToRunTimeSelectionTable.H"
#include <cmath>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(materialPointHDF5, 0);
    addToRunTimeSelectionTable(functionObject, materialPointHDF5, dictionary);

    static const functionNeeds::add needsOfMaterialPointHDF5
    (
        "materialPointHDF5", functionNeeds::NO_FIELDS
    );
}
}

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

using namespace Foam;

//- Call op(rank, values) on the master for each rank. Collective.
template<class Type, class Op>
void forRanks(const Field<Type>& values, const Op& op)
{
    if (!Pstream::master())
    {
        OPstream os(Pstream::commsTypes::scheduled, Pstream::masterNo());
        os << values;
        return;
    }
    op(Pstream::masterNo(), values);
    for (label rank = 1; rank < Pstream::nProcs(); ++rank)
    {
        IPstream is(Pstream::commsTypes::scheduled, rank);
        op(rank, Field<Type>(is));
    }
}

} // End anonymous namespace


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::materialPointHDF5::checkAlone(const dictionary& dict) const
{
    const dictionary functions
    (
        mesh_.time().controlDict().subOrEmptyDict("functions")
    );
    for (const entry& e : functions)
    {
        if
        (
            e.isDict()
         && e.keyword() != name()
         && e.dict().lookupOrDefault<word>("type", word::null) == type()
         && e.dict().lookupOrDefault<word>("cloud", word::null)
         == cloud().name()
         && e.dict().lookupOrDefault<bool>("enabled", true)
        )
        {
            FatalIOErrorInFunction(dict)
                << "keyword cloud is " << cloud().name() << ", as in function"
                << " object " << e.keyword() << ", and both would write to one"
                << " file." << nl
                << "    Allowed: one " << type() << " per cloud"
                << exit(FatalIOError);
        }
    }
}


bool Foam::mpm::materialPointHDF5::wanted(const word& field) const
{
    return
        fields_.empty() || field == "id" || field == "x"
     || fields_.match(field);
}


void Foam::mpm::materialPointHDF5::checkFields(const dictionary& dict) const
{
    wordList known;
    cloud().visitFields
    (
        [&](const word& field, const auto&) { known.append(field); }
    );
    for (const wordRe& pattern : fields_)
    {
        if (!findStrings(pattern, known).empty()) continue;

        sort(known);
        FatalIOErrorInFunction(dict)
            << "keyword fields: " << pattern << " is no field of the cloud "
            << cloud().name() << '.' << nl
            << "    Allowed: " << listed(known) << exit(FatalIOError);
    }
}


Foam::List<Foam::labelList> Foam::mpm::materialPointHDF5::order
(
    const labelUList& points,
    std::vector<int64_t>& ids
) const
{
    List<labelList> place(Pstream::nProcs());
    std::vector<int64_t> all;

    cloud().visitFields
    (
        [&](const word& field, const auto& values)
        {
            if constexpr (std::is_same<decltype(values()), tmp<scalarField>>())
            {
                if (field != "id") return;
                forRanks
                (
                    chosen(values(), points)(),
                    [&](const label rank, const scalarField& part)
                    {
                        place[rank].setSize(part.size());
                        for (const scalar id : part)
                        {
                            all.push_back(std::llround(id));
                        }
                    }
                );
            }
        }
    );

    std::vector<label> sorted(all.size());
    for (size_t i = 0; i < sorted.size(); ++i) sorted[i] = i;
    std::stable_sort
    (
        sorted.begin(), sorted.end(),
        [&](const label a, const label b) { return all[a] < all[b]; }
    );
    std::vector<label> placeOf(all.size());
    ids.resize(all.size());
    for (size_t i = 0; i < sorted.size(); ++i)
    {
        placeOf[sorted[i]] = i;
        ids[i] = all[sorted[i]];
    }
    size_t i = 0;
    for (labelList& part : place)
    {
        for (label& k : part) k = placeOf[i++];
    }
    return place;
}


template<class Type>
Foam::tmp<Foam::Field<Type>> Foam::mpm::materialPointHDF5::chosen
(
    tmp<Field<Type>> values,
    const labelUList& points
) const
{
    if (selection_.all()) return values;
    return tmp<Field<Type>>(new Field<Type>(values(), points));
}


template<class Type>
std::vector<Foam::scalar> Foam::mpm::materialPointHDF5::gather
(
    const Field<Type>& values,
    const List<labelList>& place,
    const label nPoints
) const
{
    const label n = pTraits<Type>::nComponents;
    std::vector<scalar> all(size_t(nPoints)*n);
    forRanks
    (
        values,
        [&](const label rank, const Field<Type>& part)
        {
            forAll(part, i)
            {
                for (label c = 0; c < n; ++c)
                {
                    all[size_t(place[rank][i])*n + c] = component(part[i], c);
                }
            }
        }
    );
    return all;
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

Foam::wordList Foam::mpm::materialPointHDF5::keywords() const
{
    wordList names({"fields", "compressionLevel", "precision"});
    names.append(pointSelection::keywords());
    return names;
}


void Foam::mpm::materialPointHDF5::readEntries(const dictionary& dict)
{
    fields_ = dict.lookupOrDefault<wordRes>("fields", wordRes());
    compressionLevel_ =
        readIntegerOrDefault(dict, "compressionLevel", 1, 0, 9);
    singlePrecision_ =
        readChoiceOrDefault(dict, "precision", "double", {"double", "single"})
     == "single";
    selection_ = pointSelection
    (
        mesh_,
        dict,
        subDictOrEmpty(mesh_.solutionDict(), "MPM")
            .lookupOrDefault<Switch>("strictKeywords", true)
    );

    checkAlone(dict);
    checkFields(dict);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::materialPointHDF5::materialPointHDF5
(
    const word& name,
    const Time& runTime,
    const dictionary& dict
)
:
    cloudFunctionObject(name, runTime, dict),
    compressionLevel_(0),
    singlePrecision_(false)
{
    read(dict);

    if (Pstream::master())
    {
        history_.reset
        (
            new pointHistory
            (
                runTime.globalPath()/"postProcessing"/typeName
               /(cloud().name() + ".h5"),
                cloud().name()
            )
        );
        history_->removeFrom(cloud().stepCount(), runTime.value());
    }
    if (started(dict)) write();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::materialPointHDF5::write()
{
    const clockTime timer;
    std::vector<int64_t> ids;
    const labelList points
    (
        selection_.all() ? labelList() : selection_.points(cloud())
    );
    const List<labelList> place(order(points, ids));
    const label nPoints = ids.size();

    if (Pstream::master())
    {
        const label step = cloud().stepCount();
        history_->setCompression(compressionLevel_);
        history_->setSinglePrecision(singlePrecision_);

        history_->begin(step, mesh_.time().value(), nPoints);
        history_->add("id", ids);
    }
    cloud().visitFields
    (
        [&](const word& field, const auto& values)
        {
            if (field == "id" || !wanted(field)) return;

            typedef typename std::decay<decltype(values()())>::type FieldType;
            const std::vector<scalar> all
            (
                gather(chosen(values(), points)(), place, nPoints)
            );
            if (Pstream::master())
            {
                history_->add
                (
                    field,
                    pTraits<typename FieldType::value_type>::nComponents,
                    all
                );
            }
        }
    );
    if (Pstream::master()) history_->end();

    if (log)
    {
        Info<< type() << ' ' << name() << ": points " << nPoints << " bytes "
            << (Pstream::master() ? fileSize(history_->lastPath(), false) : 0)
            << " seconds " << timer.elapsedTime() << endl;
    }
    return true;
}

// ************************************************************************* //
