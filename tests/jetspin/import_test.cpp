#include "ehdjet/core/error.hpp"

#include <gtest/gtest.h>

#include <gmock/gmock.h>
#include <random>
#include <sstream>

#include "jetspin/inputs.hpp"

namespace ehdjet {
namespace {

using namespace test;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

ImportedScene imported(const std::string& text, const JetspinImportOptions& options = {}) {
  return import_jetspin(text, "input.dat", options);
}

/// The message of the refusal.
std::string refusal(const std::string& text, const JetspinImportOptions& options = {}) {
  try {
    read_imported(imported(text, options));
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

/// Example 3 with other records in front of its `finish`, which is on line 31.
std::string jet_with(const std::string& records) {
  std::string text = example_text(3);
  return text.insert(text.find("finish"), records + "\n");
}
SceneConfig config_with(const std::string& records,
                        const JetspinImportOptions& options = {}) {
  return read_imported(imported(jet_with(records), options)).config;
}

std::string without(std::string text, const std::string& record) {
  const std::size_t at = text.find(record);
  return text.erase(at, text.find('\n', at) - at);
}

TEST(JetspinImport, gives_the_scene_of_the_same_jet) {
  const SceneConfig c = example(3).config;
  const SceneConfig pvp = read_scene(EHDJET_SCENES "/pvp.toml").config;
  EXPECT_EQ(c.nozzle->radius, pvp.nozzle->radius);
  EXPECT_EQ(c.nozzle->link_length, pvp.nozzle->link_length);
  EXPECT_DOUBLE_EQ(*c.nozzle->velocity, *pvp.nozzle->velocity);
  EXPECT_DOUBLE_EQ(c.nozzle->density, pvp.nozzle->density);
  EXPECT_DOUBLE_EQ(*c.nozzle->charge_density, *pvp.nozzle->charge_density);
  EXPECT_EQ(c.nozzle->amplitude, pvp.nozzle->amplitude);
  EXPECT_EQ(c.nozzle->angular_frequency, pvp.nozzle->angular_frequency);
  EXPECT_EQ(c.nozzle->insertion_velocity, pvp.nozzle->insertion_velocity);
  EXPECT_EQ(c.collector->distance, pvp.collector->distance);
  EXPECT_NEAR(*c.field->potential / *pvp.field->potential, 1, 1e-9); // it has ten digits
  EXPECT_EQ(c.gravity, pvp.gravity);
  EXPECT_EQ(c.viscoelasticity, pvp.viscoelasticity);
  EXPECT_EQ(c.surface_tension, pvp.surface_tension);
  EXPECT_EQ(c.run.end_time, 0.5);
  EXPECT_EQ(*c.output.observables, 1e-2);
  EXPECT_EQ(*c.output.frames, 1e-4);
  EXPECT_TRUE(c.output.deposit);
  EXPECT_FALSE(c.air || c.refinement || c.evaporation || c.chain);
}

TEST(JetspinImport, gives_a_chain_if_nothing_is_inserted) {
  const Scene scene = example(1), startup = read_scene(EHDJET_SCENES "/startup.toml");
  ASSERT_EQ(scene.chain.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_DOUBLE_EQ(scene.chain.x[k], startup.chain.x[k]);
    EXPECT_DOUBLE_EQ(scene.chain.mass[k], startup.chain.mass[k]);
    EXPECT_DOUBLE_EQ(scene.chain.charge[k], startup.chain.charge[k]);
    EXPECT_DOUBLE_EQ(scene.chain.volume[k], startup.chain.volume[k]);
  }
  EXPECT_EQ(scene.config.chain->fixed, FixedEnds::first);
  EXPECT_DOUBLE_EQ(*scene.config.field->strength, *startup.config.field->strength);
  EXPECT_EQ(scene.config.viscoelasticity, startup.config.viscoelasticity);
  EXPECT_FALSE(scene.config.collector);
}

TEST(JetspinImport, imports_what_the_other_examples_add) {
  const SceneConfig straight = example(2).config, air = example(4).config,
                    refined = example(5).config, body = example(6).config;
  EXPECT_EQ(straight.nozzle->link_length, 1e-3);
  EXPECT_FALSE(straight.surface_tension);
  EXPECT_EQ(straight.collector->charge, CollectorCharge::grounded);
  EXPECT_DOUBLE_EQ(air.air->density, 1.21);
  EXPECT_DOUBLE_EQ(air.air->kinematic_viscosity, 1.511e-5);
  EXPECT_EQ(air.air->velocity->at(0), -10);
  EXPECT_EQ(air.air->drag, DragLaw::tangential);
  EXPECT_TRUE(air.air->lift);
  EXPECT_EQ(refined.refinement->length, 2e-3);
  EXPECT_EQ(*refined.refinement->interval, 1e-3);
  EXPECT_EQ(body.viscoelasticity->model, Rheology::kelvin_voigt);
  EXPECT_EQ(*body.viscoelasticity->elastic_modulus, 1e-3);
  EXPECT_EQ(*body.viscoelasticity->viscosity, 1);
  EXPECT_EQ(*body.output.frames, 1e-3);
}

TEST(JetspinImport, says_of_every_key_where_it_comes_from) {
  for (int number = 1; number <= 6; ++number) {
    std::istringstream text(imported(example_text(number), {.without_noise = true}).text);
    for (std::string line; std::getline(text, line);)
      if (line.find(" = ") != std::string::npos && line.front() != '#') {
        EXPECT_THAT(line, HasSubstr("  # ")) << number;
      }
  }
  EXPECT_THAT(imported(example_text(3)).text,
              HasSubstr("# line 17: nozzle cross 0.005 cm\n"));
}

TEST(JetspinImport, names_what_it_leaves_out_in_remarks_and_in_the_scene) {
  const ImportedScene scene = imported(example_text(6));
  for (const char* what : {"multiple step yes: every step has the forces of all pairs",
                           "primary cutoff 1: every step", "maximum displ 0.1: every step",
                           "print list: observables have all columns", "seed 317"}) {
    EXPECT_THAT(scene.remarks, Contains(HasSubstr(what)));
    EXPECT_THAT(scene.text, HasSubstr(what));
  }
  // Nothing is lost: every record is a comment of a key, or is named.
  EXPECT_THAT(imported(jet_with("airdrag airdensity 1.d-3")).remarks,
              Contains("line 31: airdrag airdensity 0.001: has no effect here"));
  EXPECT_THAT(imported(jet_with("timestep 2.d-8")).remarks,
              Contains("line 31: replaces line 4: timestep"));
}

// The rules of JETSPIN's parser.
TEST(JetspinImport, reads_records_as_jetspin_does) {
  const auto radius = [](const std::string& record) {
    return config_with(record).nozzle->radius;
  };
  EXPECT_EQ(radius("nozzle cross 4.d-3"), 4e-5);
  EXPECT_EQ(radius("  NOZZLE Cross-section 4.D-3"), 4e-5);
  EXPECT_EQ(radius("nozzle crossing of 4e-3 5 6"), 4e-5);
  EXPECT_EQ(radius("the cross of the nozzle .004"), 4e-5);
  EXPECT_EQ(radius("nozzle cross 0.004d"), 4e-5);
  EXPECT_EQ(radius("nozzle cross 0.4d-0002\r"), 4e-5);
  EXPECT_EQ(radius("nozzle cross=0.004 ! cm"), 4e-5);
  // The exponent are the next digits, wherever they are.
  EXPECT_EQ(radius("nozzle cross 4.d !cm -3"), 4e-5);
  EXPECT_THAT(imported(jet_with("nozzle cross 4.d !cm -3")).remarks,
              Contains(AllOf(HasSubstr("line 31"), HasSubstr("is read as 0.004"))));
  EXPECT_EQ(radius("#nozzle cross 4.d-3"), 5e-5);
  EXPECT_EQ(radius("  ! nozzle cross 4.d-3"), 5e-5);
  EXPECT_EQ(radius("finish\nnozzle cross 4.d-3"), 5e-5);
  // Of a record only 150 characters count.
  const std::string blanks(132, ' '), record = "nozzle cross 4.d-3";
  EXPECT_EQ(radius(record + blanks + "5"), 4e-5);
  EXPECT_THAT(imported(jet_with(record + blanks + "5")).remarks,
              Contains(HasSubstr("what follows character 150 is not read")));
  EXPECT_THAT(imported(jet_with(record + blanks + " ")).remarks,
              Not(Contains(HasSubstr("character 150"))));
  EXPECT_THAT(refusal(jet_with("nozzle cross" + blanks + "      4.d-3")),
              HasSubstr("needs a number"));
}

TEST(JetspinImport, takes_the_first_directive_in_a_fixed_order) {
  // "points" comes before "nozzle", "initial" before "viscosity".
  EXPECT_EQ(config_with("nozzle points 2").nozzle->link_length, 1e-4);
  EXPECT_THAT(
      refusal(jet_with("viscosity 20 initial value")),
      HasSubstr(
          "input.dat:31: \"viscosity 20 initial value\": no directive. The nearest is"));
  // Within a directive, too: "yes" comes before "freq".
  EXPECT_EQ(config_with("perturb freq 3 yes").nozzle->angular_frequency, 1e4);
  EXPECT_EQ(config_with("timesteps 2.d-8", {.fixed_steps = true}).integrator.step, 2e-8);
}

TEST(JetspinImport, refuses_what_is_no_directive_and_names_the_nearest) {
  const auto nearest = [](const std::string& record, const std::string& directive) {
    EXPECT_THAT(refusal(jet_with(record)),
                AllOf(HasSubstr("input.dat:31: \"" + record + "\""),
                      HasSubstr("The nearest is \"" + directive + "\"")));
  };
  nearest("nozle cross 0.005", "nozzle cross");
  nearest("viscosty 20.d0", "viscosity");
  nearest("perturbation frecuency 1.d4", "perturb freq");
  nearest("dynamic refinement treshold 0.2", "dynam refin threshold");
  nearest("external potenial 30", "external potential");
  nearest("noise varianc 3", "noise variance");
  nearest("airdrag airvelocty 3", "airdrag airvelocity");
  EXPECT_THAT(refusal(jet_with("nozzle\tcross 0.005")),
              HasSubstr("tabs do not separate words"));
  EXPECT_THAT(refusal(jet_with("nozzle cross")), HasSubstr("needs a number"));
  EXPECT_THAT(refusal(jet_with("nozzle cross 1.2.3")), HasSubstr("needs a number"));
  EXPECT_THAT(refusal(jet_with("nozzle cross 1.d999")), HasSubstr("needs a number"));
  EXPECT_THAT(refusal(jet_with("points 1.5")), HasSubstr("needs a whole number"));
  EXPECT_THAT(refusal(jet_with("external potential vector 1 2")),
              HasSubstr("needs 3 numbers"));
  EXPECT_THAT(refusal(without(example_text(3), "finish")),
              HasSubstr("without the record \"finish\""));
  EXPECT_THAT(refusal(without(example_text(3), "nozzle cross")),
              HasSubstr("input.dat: \"nozzle cross\" is missing"));
  EXPECT_THAT(refusal(jet_with("resolution 0.01")),
              HasSubstr("both \"points\" and \"resolution\""));
}

TEST(JetspinImport, refuses_what_ehdjet_does_not_have) {
  EXPECT_THAT(
      refusal(example_text(4)),
      AllOf(HasSubstr("input.dat:13: airdrag amplitude 1"), HasSubstr("--without-noise")));
  EXPECT_THAT(refusal(jet_with("noise yes\nnoise diffusivity 2\nnoise variance 1")),
              HasSubstr("input.dat:32: noise diffusivity 2"));
  EXPECT_THAT(imported(example_text(4), {.without_noise = true}).remarks,
              Contains("line 13: airdrag amplitude 1: the random force is left out"));
  for (const char* record :
       {"lorentz yes", "variable mass yes", "restart yes", "wall yes", "mirror yes",
        "breakup yes", "dragvel yes type 2", "external potential vector 1 2 3"})
    EXPECT_THAT(refusal(jet_with(record)), HasSubstr("input.dat:31: ")) << record;
  EXPECT_THAT(refusal(jet_with("external potential type 3\nexternal potential freq 5")),
              HasSubstr("no rotating field"));
  EXPECT_THAT(refusal(jet_with("external potential type 2\nexternal potential freq 5\n"
                               "external potential time 1.d-3")),
              HasSubstr("is switched off after 0.1 s"));
  EXPECT_THAT(refusal(jet_with("kvfluid yes\nhbfluid yes")), HasSubstr("remove one"));
  EXPECT_THAT(refusal(jet_with("inserting no")), HasSubstr("the end of a chain"));
}

TEST(JetspinImport, names_the_directive_of_a_value_that_a_scene_may_not_have) {
  EXPECT_THAT(refusal(jet_with("nozzle cross 3")),
              AllOf(HasSubstr("nozzle.radius = 0.03"),
                    HasSubstr("nozzle.radius is from line 31: nozzle cross 3 cm")));
}

TEST(JetspinImport, converts_waveforms_fluids_and_units) {
  const SceneConfig square =
      config_with("external potential type 1\nexternal potential freq 250");
  EXPECT_EQ(square.field->waveform, FieldWaveform::square);
  EXPECT_EQ(*square.field->frequency, 250);
  const SceneConfig rc =
      config_with("external potential type 2\nexternal potential freq 1\n"
                  "external potential time 2.d-3");
  EXPECT_EQ(rc.field->waveform, FieldWaveform::rc);
  EXPECT_EQ(*rc.field->time_constant, 2e-3);

  // K = k mu: 1.5 times 20 P s^(n-1).
  const auto flow = *config_with("hbfluid yes\nhbfluid consistency 1.5\nhbfluid index 0.8\n"
                                 "yield stress 30")
                         .viscoelasticity;
  EXPECT_EQ(flow.model, Rheology::herschel_bulkley);
  EXPECT_EQ(*flow.consistency, 3);
  EXPECT_EQ(*flow.flow_index, 0.8);
  EXPECT_EQ(*flow.yield_stress, 3);
  EXPECT_EQ(config_with("yield stress 30").viscoelasticity->flow_index, 1);

  const SceneConfig real =
      config_with("units real\ndensity charge 0.0146768\nexternal potential 9000");
  EXPECT_DOUBLE_EQ(*real.nozzle->charge_density, 14.6768);
  EXPECT_EQ(*real.field->potential, 9000);

  EXPECT_EQ(config_with("dragvel no").nozzle->insertion_velocity,
            InsertionVelocity::nozzle);
  EXPECT_EQ(config_with("perturb phase 1.5").nozzle->phase, 1.5);
  EXPECT_EQ(config_with("perturb no").nozzle->amplitude, 0);
  EXPECT_FALSE(config_with("gravity no").gravity);
}

TEST(JetspinImport, dries_a_jet_with_the_density_of_its_vapour) {
  const std::string air =
      "airdrag yes\nairdrag airdensity 1.21d-3\nairdrag airviscosity 0.151\n";
  const std::string drying =
      "evaporation yes\nevaporation polymer frac 0.06\nevaporation temperature 293.15\n"
      "evaporation umidity 0.165\nevaporation bconst 7\nevaporation mconst 0.1\n"
      "evaporation airviscosity 0.151";
  const SceneConfig c = config_with(air + drying);
  ASSERT_TRUE(c.evaporation);
  // Water at 20 C: 2339 Pa, 0.0173 kg/m^3.
  EXPECT_NEAR(c.evaporation->saturation, 0.0173, 1e-4);
  EXPECT_NEAR(c.evaporation->diffusivity, 2.42e-5, 2e-7); // 0.211 (T/273.15)^1.94 cm^2/s
  EXPECT_EQ(c.evaporation->polymer_fraction, 0.06);
  EXPECT_EQ(c.evaporation->humidity, 0.165);
  EXPECT_EQ(c.evaporation->still_air_sherwood, 0);
  EXPECT_EQ(*c.evaporation->viscosity_exponent, 7);
  EXPECT_EQ(*c.evaporation->viscosity_power, 0.1);
  EXPECT_NEAR(config_with(air + drying + "\nevaporation relumidity 0.0230655")
                  .evaporation->saturation,
              c.evaporation->saturation, 1e-5);
  EXPECT_THAT(refusal(jet_with(drying)), HasSubstr("dries in air"));
  EXPECT_THAT(refusal(jet_with(air + drying + "\nevaporation tconst 0.5")),
              HasSubstr("tconst 0.5"));
}

TEST(JetspinImport, keeps_the_steps_if_asked) {
  const SceneConfig c = config_with("", {.fixed_steps = true});
  EXPECT_EQ(c.integrator.method, "heun");
  EXPECT_EQ(*c.integrator.step, 1e-8);
  EXPECT_EQ(c.integrator.events, EventPlacement::step_end);
  EXPECT_THAT(imported(example_text(3)).text,
              AllOf(HasSubstr("method = \"heun\""), HasSubstr("step = 1e-08"),
                    Not(HasSubstr("\nstep"))));
}

/// A random input must give a scene or be refused; nothing else.
bool is_imported(const std::string& text) {
  try {
    const ImportedScene scene = imported(text, {.without_noise = true});
    if (scene.beads.empty()) check_imported(scene, "input.dat", ".");
    return true;
  } catch (const InputError&) {
    return false;
  }
}

TEST(JetspinImport, survives_any_bytes) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 2000; ++k) {
    std::string text(random() % 400, ' ');
    for (char& c : text) c = static_cast<char>(random() % 256);
    EXPECT_FALSE(is_imported(text));
  }
}

TEST(JetspinImport, survives_damaged_examples) {
  std::mt19937_64 random(2);
  int scenes = 0;
  for (int k = 0; k < 3000; ++k) {
    std::string text = example_text(1 + k % 6);
    for (std::uint64_t change = random() % 4; change-- > 0;) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
      case 0:
        text[at] = static_cast<char>(random() % 256);
        break;
      case 1:
        text.erase(at, random() % 8);
        break;
      case 2:
        text.insert(at, text.substr(random() % text.size(), random() % 30));
        break;
      default:
        text[at] = "0123456789.de-+ \n"[random() % 17];
      }
    }
    if (is_imported(text)) ++scenes;
  }
  EXPECT_GT(scenes, 500);
}

} // namespace
} // namespace ehdjet
