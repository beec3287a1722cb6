// Stand-ins for the parts of rclcpp, ros2_control and realtime_tools that an exported controller
// uses, written from their documented signatures: they show that it compiles and what it computes,
// not that it runs in ROS. HUMBLE selects the older generation of the handles.
#ifndef STAND_IN_HPP
#define STAND_IN_HPP

#include <chrono>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rclcpp
{
struct Logger {};
class Time {};
class Duration {};
class SystemDefaultsQoS {};
struct TimerBase
{
  using SharedPtr = std::shared_ptr<TimerBase>;
  std::function<void()> call;
};
template<typename Message>
struct Subscription
{
  using SharedPtr = std::shared_ptr<Subscription>;
  std::function<void(std::shared_ptr<Message>)> call;
};
struct Parameter
{
  std::string value;
  std::string as_string() const {return value;}
};
inline std::vector<std::string> & logged()
{
  static std::vector<std::string> lines;
  return lines;
}
inline void log(const Logger &, const char * format, ...)
{
  char line[512];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  logged().push_back(line);
}
}  // namespace rclcpp

#define RCLCPP_ERROR(...) rclcpp::log(__VA_ARGS__)

namespace std_msgs::msg
{
struct Float64
{
  using SharedPtr = std::shared_ptr<Float64>;
  double data = 0.0;
};
}  // namespace std_msgs::msg

namespace rclcpp_lifecycle
{
class State {};
class LifecycleNode
{
public:
  rclcpp::Logger get_logger() const {return {};}
  rclcpp::Parameter get_parameter(const std::string & name) const {return {parameters.at(name)};}
  template<typename Message, typename Callback>
  std::shared_ptr<rclcpp::Subscription<Message>> create_subscription(
    const std::string &, const rclcpp::SystemDefaultsQoS &, Callback callback)
  {
    auto made = std::make_shared<rclcpp::Subscription<Message>>();
    made->call = callback;
    subscriptions.push_back(made);
    return made;
  }
  template<typename Period, typename Callback>
  rclcpp::TimerBase::SharedPtr create_wall_timer(Period, Callback callback)
  {
    auto made = std::make_shared<rclcpp::TimerBase>();
    made->call = callback;
    timers.push_back(made);
    return made;
  }
  std::map<std::string, std::string> parameters;
  std::vector<std::shared_ptr<rclcpp::Subscription<std_msgs::msg::Float64>>> subscriptions;
  std::vector<rclcpp::TimerBase::SharedPtr> timers;
};
namespace node_interfaces
{
class LifecycleNodeInterface
{
public:
  enum class CallbackReturn : std::uint8_t {SUCCESS, FAILURE, ERROR};
  virtual ~LifecycleNodeInterface() = default;
  virtual CallbackReturn on_configure(const rclcpp_lifecycle::State &) {return CallbackReturn::SUCCESS;}
  virtual CallbackReturn on_activate(const rclcpp_lifecycle::State &) {return CallbackReturn::SUCCESS;}
  virtual CallbackReturn on_deactivate(const rclcpp_lifecycle::State &) {return CallbackReturn::SUCCESS;}
};
}  // namespace node_interfaces
}  // namespace rclcpp_lifecycle

namespace hardware_interface
{
class Handle
{
public:
  Handle(std::string name, double * value) : name_(std::move(name)), value_(value) {}
  const std::string get_name() const {return name_;}
#ifdef HUMBLE
  double get_value() const {return *value_;}
  void set_value(double value) {*value_ = value;}
#else
  template<typename T = double>
  [[nodiscard]] std::optional<T> get_optional(unsigned int = 10) const {return *value_;}
  template<typename T>
  [[nodiscard]] bool set_value(const T & value, unsigned int = 10)
  {
    *value_ = value;
    return true;
  }
#endif

private:
  std::string name_;
  double * value_;
};
using LoanedCommandInterface = Handle;
using LoanedStateInterface = Handle;
}  // namespace hardware_interface

namespace controller_interface
{
using CallbackReturn = rclcpp_lifecycle::node_interfaces::LifecycleNodeInterface::CallbackReturn;
enum class return_type : std::uint8_t {OK = 0, ERROR = 1};
enum class interface_configuration_type : std::uint8_t {ALL = 0, INDIVIDUAL = 1, NONE = 2};
struct InterfaceConfiguration
{
  interface_configuration_type type;
  std::vector<std::string> names = {};
};
class ControllerInterface : public rclcpp_lifecycle::node_interfaces::LifecycleNodeInterface
{
public:
  virtual CallbackReturn on_init() = 0;
  virtual InterfaceConfiguration command_interface_configuration() const = 0;
  virtual InterfaceConfiguration state_interface_configuration() const = 0;
  virtual return_type update(const rclcpp::Time &, const rclcpp::Duration &) = 0;
  std::shared_ptr<rclcpp_lifecycle::LifecycleNode> get_node() {return node;}
  std::shared_ptr<const rclcpp_lifecycle::LifecycleNode> get_node() const {return node;}
  unsigned int get_update_rate() const {return rate;}
  void assign(
    std::vector<hardware_interface::LoanedCommandInterface> commands,
    std::vector<hardware_interface::LoanedStateInterface> states)
  {
    command_interfaces_ = std::move(commands);
    state_interfaces_ = std::move(states);
  }
  template<typename T>
  void auto_declare(const std::string & name, const T & value)
  {
    node->parameters.emplace(name, value);
  }
  std::shared_ptr<rclcpp_lifecycle::LifecycleNode> node =
    std::make_shared<rclcpp_lifecycle::LifecycleNode>();
  unsigned int rate = 0;

protected:
  std::vector<hardware_interface::LoanedCommandInterface> command_interfaces_;
  std::vector<hardware_interface::LoanedStateInterface> state_interfaces_;
};
}  // namespace controller_interface

namespace realtime_tools
{
template<typename T>
class RealtimeBuffer
{
public:
  T * readFromRT() {return &value_;}
  void writeFromNonRT(const T & value) {value_ = value;}

private:
  T value_{};
};
}  // namespace realtime_tools

#define PLUGINLIB_EXPORT_CLASS(one, base) \
  std::unique_ptr<base> exported() {return std::make_unique<one>();}

#endif
