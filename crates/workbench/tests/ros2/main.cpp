// Configures, activates and runs an exported controller: reads samples of reference, measurement,
// velocity and pressure, and writes commands.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "stand_in.hpp"

std::unique_ptr<controller_interface::ControllerInterface> exported();

static unsigned long long allocations = 0;

void * operator new(std::size_t size)
{
  allocations++;
  return std::malloc(size);
}
void operator delete(void * memory) noexcept {std::free(memory);}
void operator delete(void * memory, std::size_t) noexcept {std::free(memory);}

using controller_interface::CallbackReturn;

static void expect(bool truth, const char * words)
{
  if (!truth) {
    std::fprintf(stderr, "%s\n", words);
    std::exit(1);
  }
}

static bool is_told(const char * words)
{
  return !rclcpp::logged().empty() && rclcpp::logged().back().find(words) != std::string::npos;
}

int main()
{
  const char * names[] = {"measurement", "velocity", "pressure"};
  double command = 0.0;
  double row[4];
  const rclcpp_lifecycle::State state;
  auto controller = exported();
  auto & parameters = controller->node->parameters;
  expect(controller->on_init() == CallbackReturn::SUCCESS, "on_init");

  controller->rate = 500;
  expect(controller->on_configure(state) == CallbackReturn::FAILURE, "another rate is accepted");
  expect(is_told("1000 samples per second") && is_told("500"), "another rate is not told");
  controller->rate = 1000;
  expect(controller->on_configure(state) == CallbackReturn::FAILURE, "no interface is accepted");
  expect(is_told("measurement_interface"), "a missing interface is not told");
  std::vector<hardware_interface::LoanedStateInterface> states;
  for (int index = 2; index >= 0; index--) {
    const std::string key = std::string(names[index]) + "_interface";
    if (parameters.count(key) != 0) {
      parameters[key] = std::string("sensor/") + names[index];
      states.emplace_back(parameters[key], &row[index + 1]);
    }
  }
  expect(controller->on_configure(state) == CallbackReturn::SUCCESS, "on_configure");
  expect(
    controller->state_interface_configuration().names.size() == states.size(), "state interfaces");
  expect(controller->command_interface_configuration().names.size() == 1, "command interface");

  row[1] = NAN;
  controller->assign({{"valve/voltage", &command}}, {});
  expect(controller->on_activate(state) == CallbackReturn::ERROR, "no state is accepted");
  expect(is_told("sensor/measurement"), "a missing state is not told");
  controller->assign({{"valve/voltage", &command}}, states);
  expect(controller->on_activate(state) == CallbackReturn::ERROR, "no number is accepted");
  expect(is_told("finite"), "a measurement without a number is not told");

  row[1] = row[2] = row[3] = 0.0;
  expect(controller->on_activate(state) == CallbackReturn::SUCCESS, "on_activate");
  auto message = std::make_shared<std_msgs::msg::Float64>();
  auto & receive = controller->node->subscriptions.back()->call;
  const rclcpp::Time time;
  const rclcpp::Duration period;
  controller->update(time, period);
  expect(std::fabs(command) <= 0.0, "the command is not held");
  expect(controller->on_activate(state) == CallbackReturn::SUCCESS, "on_activate again");
  while (std::fread(row, sizeof row, 1, stdin) == 1) {
    message->data = row[0];
    receive(message);
    const unsigned long long before = allocations;
    controller->update(time, period);
    expect(allocations == before, "update allocates");
    std::fwrite(&command, sizeof command, 1, stdout);
  }
  const double last = command;
  row[1] = NAN;
  controller->update(time, period);
  expect(std::memcmp(&last, &command, sizeof last) == 0, "the last command is not repeated");
  controller->node->timers.back()->call();
  expect(is_told("1 samples had a signal"), "a signal without a number is not told");
  return 0;
}
