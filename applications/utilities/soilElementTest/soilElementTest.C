/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Application
    soilElementTest

Group
    grpPreProcessingUtilities

Description
    Laboratory tests on one point of the soil of a case: reads the solver's
    constant/materialPointProperties, so that what is tested is what runs, and
    needs neither mesh nor points.

    Writes postProcessing/soilElementTest/<name>.csv for each test, and prints
    a summary.

Usage
    In system/soilElementTestDict:
    \verbatim
    tests
    {
        dense100
        {
            test            drainedTriaxial;
            p0              100e3;
            e0              0.65;
            strain          0.2;
            strainIncrement 1e-4;
        }
    }
    \endverbatim
    or the entries of one test without the sub-dictionaries. Where the case has
    several solids, \c cloud beside \c tests says which.

    \table
        Property        | Description                             | Default
        cloud           | solid of the case                       | the only one
        test            | see elementTest                         | required
        p0              | pressure at the start [Pa]              | required
        e0              | void ratio at the start                 | soil's
        strain          | given strain at the end                 | required
        strainIncrement | given strain per step                   | 1e-4
        cycles          | go there and back so often; 0: only there | 0
        integrator      | radialReturn or adaptiveSubstepping     | \\
                          radialReturn
        writeInterval   | steps per row of the CSV                | 10
    \endtable
    and the other entries of elementTest.

    Columns: given strain, volumetric strain, void ratio, pressure p and
    deviator q of the whole effective stress, those of the skeleton without
    viscous part (pSkeleton, qSkeleton), the stress components xx yy zz xy, the
    model's state fields, work and elastic energy. SI units; strain logarithmic;
    strain and stress positive in compression.

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "IOdictionary.H"
#include "OSspecific.H"
#include "OFstream.H"
#include "clockTime.H"
#include "sigFpe.H"
#include "dictionaryEntries.H"
#include "listed.H"
#include "phaseRole.H"
#include "elementTest.H"
#include "adaptiveSubstepping.H"
#include <cmath>
#include <limits>

using namespace Foam;

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

//- The model of the soil, with the integrator that a test asks for
static autoPtr<mpm::soilModel> modelOf
(
    const dictionary& soil,
    const word& integrator,
    const dictionary& test,
    const bool strict
)
{
    if (integrator != "adaptiveSubstepping")
    {
        return mpm::soilModel::New(soil, strict);
    }
    const word model(soil.get<word>("constitutiveModel"));
    if (model != mpm::elastoplasticMuI::typeName)
    {
        FatalIOErrorInFunction(test)
            << "keyword integrator has the value " << integrator
            << " with the constitutiveModel " << model << '.' << nl
            << "    Allowed: radialReturn; adaptiveSubstepping with "
            << mpm::elastoplasticMuI::typeName << exit(FatalIOError);
    }
    return autoPtr<mpm::soilModel>
    (
        new mpm::adaptiveSubstepping
        (
            mpm::subDictOf
            (
                soil, word(mpm::elastoplasticMuI::typeName) + "Coeffs"
            ),
            strict
        )
    );
}


//- The start of a test; a stress that the model cannot carry is an error of
//  the test's dictionary
static autoPtr<mpm::elementTest> startOf
(
    const mpm::soilModel& model,
    const mpm::elementTest::settings& settings,
    const dictionary& test
)
{
    autoPtr<mpm::elementTest> element;
    const bool throwing = FatalIOError.throwExceptions(true);
    std::string reason;
    try
    {
        element.reset(new mpm::elementTest(model, settings));
    }
    catch (const IOerror& e)
    {
        reason = e.message();
    }
    FatalIOError.throwExceptions(throwing);

    if (!element.valid())
    {
        FatalIOErrorInFunction(test)
            << "keyword K0 has the value " << settings.K0 << ", p0 "
            << settings.p0 << ", e0 " << settings.e0 << '.' << nl << "    "
            << reason.c_str() << exit(FatalIOError);
    }
    return element;
}


static void writeRow(Ostream& os, const mpm::elementTest& t, const label nState)
{
    os  << t.strain() << ',' << t.volumetricStrain() << ',' << t.voidRatio()
        << ',' << t.pressure() << ',' << t.deviator()
        << ',' << t.skeletonPressure() << ',' << t.skeletonDeviator();
    for (label c = 0; c < 4; ++c) os << ',' << t.stress(c);
    for (label i = 0; i < nState; ++i) os << ',' << t.state(i);
    os  << ',' << t.work() << ',' << t.elasticEnergy() << '\n';
}


//- Run one test
static void run
(
    const word& name,
    const dictionary& dict,
    const dictionary& soil,
    const fileName& directory,
    const bool strict
)
{
    wordList known(mpm::elementTest::keywords());
    known.append
    (
        wordList
        ({
            "strain", "strainIncrement", "cycles", "integrator",
            "writeInterval"
        })
    );
    mpm::checkKeywords(dict, known, strict);

    const word integrator = mpm::readChoiceOrDefault
    (
        dict, "integrator", "radialReturn",
        {"radialReturn", "adaptiveSubstepping"}
    );
    autoPtr<mpm::soilModel> model(modelOf(soil, integrator, dict, strict));

    const auto settings = mpm::elementTest::readSettings(dict, *model);
    const scalar strain = mpm::readPositive(dict, "strain", dimless);
    const scalar increment = mpm::readBoundedOrDefault
    (
        dict, "strainIncrement", dimless, 1e-4, 0, strain, false, true
    );
    const label cycles =
        mpm::readIntegerOrDefault(dict, "cycles", 0, 0, 1000000);
    const label interval =
        mpm::readIntegerOrDefault(dict, "writeInterval", 10, 1);

    // Also of all legs together
    const scalar mostSteps = scalar(std::numeric_limits<int>::max());
    const scalar steps = max(scalar(1), std::round(strain/increment));
    if (!(steps*max(label(1), 2*cycles) <= mostSteps))
    {
        FatalIOErrorInFunction(dict)
            << "keyword strain has the value " << strain
            << ", strainIncrement " << increment << ": "
            << steps*max(label(1), 2*cycles) << " steps." << nl
            << "    Allowed: strain/strainIncrement, times twice the cycles, up"
            << " to " << mostSteps << exit(FatalIOError);
    }

    autoPtr<mpm::elementTest> test(startOf(*model, settings, dict));

    const wordList fields(model->stateFields());
    OFstream file(directory/name + ".csv");
    file.precision(10);
    file<< "# soilElementTest " << name << ": "
        << mpm::elementTest::testNames[settings.test] << ", p0 "
        << settings.p0 << " Pa, e0 " << settings.e0 << ", " << integrator
        << ", strain increment " << increment << nl
        << "strain,volumetricStrain,voidRatio,p,q,pSkeleton,qSkeleton,"
        << "sigma_xx,sigma_yy,sigma_zz,sigma_xy";
    for (const word& f : fields) file << ',' << f;
    file<< ",work,elasticEnergy" << nl;
    writeRow(file, *test, fields.size());

    const label nSteps = label(steps);
    const scalar step = strain/nSteps;

    scalar qMax = 0, strainOfQMax = 0, ratioMax = 0;
    const clockTime clock;
    label done = 0;
    for (label leg = 0; leg < max(label(1), 2*cycles); ++leg)
    {
        for (label i = 0; i < nSteps; ++i)
        {
            test->advance(leg % 2 ? -step : step);
            const scalar q = test->deviator();
            if (!test->finite())
            {
                writeRow(file, *test, fields.size());
                FatalIOErrorInFunction(dict)
                    << "test " << name << ": the state is not finite at strain "
                    << test->strain() << " (step " << done + 1 << "): p "
                    << test->pressure() << " Pa, q " << q << " Pa, void ratio "
                    << test->voidRatio() << '.' << nl
                    << "    strain has the value " << strain
                    << ", strainIncrement " << increment << ", strainRate "
                    << settings.strainRate << "; allowed: less of them"
                    << exit(FatalIOError);
            }
            if (q > qMax)
            {
                qMax = q;
                strainOfQMax = test->strain();
            }
            if (test->pressure() > 0)
            {
                ratioMax = max(ratioMax, q/test->pressure());
            }
            if (++done % interval == 0 || i + 1 == nSteps)
            {
                writeRow(file, *test, fields.size());
            }
        }
    }

    Info<< name << ": " << mpm::elementTest::testNames[settings.test]
        << ", p0 " << settings.p0 << " Pa, e0 " << settings.e0 << ", "
        << integrator << ", " << done << " steps in "
        << clock.elapsedTime() << " s" << nl
        << "    largest q " << qMax << " Pa at strain " << strainOfQMax
        << ", largest q/p " << ratioMax << nl
        << "    end: strain " << test->strain() << ", p " << test->pressure()
        << " Pa, q " << test->deviator() << " Pa, void ratio "
        << test->voidRatio() << ", volumetric strain "
        << test->volumetricStrain() << endl;

    if (!file.good())
    {
        FatalErrorInFunction
            << "cannot write " << file.name() << exit(FatalError);
    }
}


//- Name of the solid to be tested
static word solid(const dictionary& properties, const dictionary& dict)
{
    DynamicList<word> solids;
    for (const word& name : properties.get<wordList>("clouds"))
    {
        const dictionary& cloud = mpm::subDictOf(properties, name);
        if (mpm::roleOf(cloud) == mpm::phaseRole::solid) solids.append(name);
    }
    if (!dict.found("cloud") && solids.size() == 1) return solids[0];

    const word name(dict.lookupOrDefault<word>("cloud", word::null));
    if (!solids.found(name))
    {
        FatalIOErrorInFunction(dict)
            << "keyword cloud is "
            << (name.empty() ? word("not given") : name) << '.' << nl
            << "    Allowed: a solid of the case, one of "
            << mpm::listed(solids) << exit(FatalIOError);
    }
    return name;
}


// * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * //

int main(int argc, char *argv[])
{
    argList::addNote("Laboratory tests on one point of the soil of a case");
    argList::noParallel();

    #include "setRootCase.H"

    sigFpe::unset(false);

    #include "createTime.H"

    auto read = [&](const word& name, const fileName& where)
    {
        return IOdictionary
        (
            IOobject
            (
                name, where, runTime, IOobject::MUST_READ, IOobject::NO_WRITE
            )
        );
    };
    const IOdictionary properties
    (
        read("materialPointProperties", runTime.constant())
    );
    const IOdictionary dict(read("soilElementTestDict", runTime.system()));

    // fvSolution may be missing: no mesh is needed
    bool strict = true;
    IOobject solution
    (
        "fvSolution", runTime.system(), runTime, IOobject::READ_IF_PRESENT
    );
    if (solution.typeHeaderOk<IOdictionary>(false))
    {
        strict = mpm::readSwitchOrDefault
        (
            mpm::subDictOrEmpty(IOdictionary(solution), "MPM"),
            "strictKeywords", true
        );
    }

    const dictionary& soil = mpm::subDictOf(properties, solid(properties, dict));
    const fileName directory
    (
        runTime.globalPath()/"postProcessing"/"soilElementTest"
    );
    mkDir(directory);

    if (dict.found("tests"))
    {
        mpm::checkKeywords(dict, {"FoamFile", "tests", "cloud"}, strict);
        const dictionary& all = mpm::subDictOf(dict, "tests");
        for (const word& name : all.toc())
        {
            run(name, mpm::subDictOf(all, name), soil, directory, strict);
        }
    }
    else
    {
        dictionary one(dict);
        one.remove("FoamFile");
        one.remove("cloud");
        run(dict.get<word>("test"), one, soil, directory, strict);
    }

    Info<< nl << "Written to " << directory << nl << nl << "End\n" << endl;

    return 0;
}

// ************************************************************************* //
